// By itself: it takes minutes to compile.
#include "device_answers.h"

namespace acdf_cuda {

std::vector<Answer> device_answers(const OfProduct& call, const std::vector<Question>& questions) {
    return all_on_device(call, questions);
}

} // namespace acdf_cuda
