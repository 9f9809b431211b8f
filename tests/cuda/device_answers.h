// A GPU's answers.
#pragma once

#include "on_device.h"
#include "questions.h"

namespace acdf_cuda {

std::vector<Answer> device_answers(const OfEnvironment& call, const std::vector<Question>& questions);
std::vector<Answer> device_answers(const OfLocal& call, const std::vector<Question>& questions);
std::vector<Answer> device_answers(const OfBrdf& call, const std::vector<Question>& questions);
std::vector<Answer> device_answers(const OfProduct& call, const std::vector<Question>& questions);
std::vector<Answer> device_answers(const OfTable& call, const std::vector<Question>& questions);

#ifdef __CUDACC__
template <class Call>
__global__ void ask(Call call, const Question* questions, Answer* answers, std::size_t count) {
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i < count) answers[i] = call(questions[i]);
}

template <class Call>
std::vector<Answer> all_on_device(const Call& call, const std::vector<Question>& questions) {
    const std::size_t count = questions.size();
    const DeviceArray<Question> asked(questions.data(), count);
    const DeviceArray<Answer> told(count);
    std::vector<Answer> out(count);
    require(cudaMemset(told.data(), 0xFF, count * sizeof(Answer)), "memory");
    ask<<<static_cast<unsigned>((count + 127) / 128), 128>>>(call, asked.data(), told.data(), count);
    require(cudaGetLastError(), "kernel");
    require(cudaMemcpy(out.data(), told.data(), count * sizeof(Answer), cudaMemcpyDeviceToHost), "kernel");
    return out;
}
#endif

} // namespace acdf_cuda
