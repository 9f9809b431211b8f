#include "device_answers.h"

namespace acdf_cuda {

std::vector<Answer> device_answers(const OfEnvironment& call, const std::vector<Question>& questions) {
    return all_on_device(call, questions);
}
std::vector<Answer> device_answers(const OfLocal& call, const std::vector<Question>& questions) {
    return all_on_device(call, questions);
}
std::vector<Answer> device_answers(const OfBrdf& call, const std::vector<Question>& questions) {
    return all_on_device(call, questions);
}
std::vector<Answer> device_answers(const OfTable& call, const std::vector<Question>& questions) {
    return all_on_device(call, questions);
}

} // namespace acdf_cuda
