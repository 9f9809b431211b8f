// Questions and the processor's answers, on all of its cores. Compiled by the host's own compiler.
#pragma once

#include "calls.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <vector>

namespace acdf_cuda {

/// Random ones, batch by batch others. `file`: the first one that is asked, whose axes and scene they fit.
std::vector<Question> questions(std::size_t count, unsigned batch, const acdf::File& file);

std::vector<Answer> host_answers(const OfEnvironment& call, const std::vector<Question>& questions);
std::vector<Answer> host_answers(const OfLocal& call, const std::vector<Question>& questions);
std::vector<Answer> host_answers(const OfBrdf& call, const std::vector<Question>& questions);
std::vector<Answer> host_answers(const OfProduct& call, const std::vector<Question>& questions);
std::vector<Answer> host_answers(const OfTable& call, const std::vector<Question>& questions);

} // namespace acdf_cuda
