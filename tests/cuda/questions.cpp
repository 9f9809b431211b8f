#include "questions.h"

#include "visibility/visible_view.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

namespace acdf_cuda {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

void unit_vector(Random& random, double least, float out[3]) {
    const double z = least + (1.0 - least) * uniform(random), phi = 2.0 * ACDF_PI * uniform(random);
    const double r = std::sqrt((1.0 - z) * (1.0 + z));
    out[0] = static_cast<float>(r * std::cos(phi));
    out[1] = static_cast<float>(r * std::sin(phi));
    out[2] = static_cast<float>(z);
}

/// A function of a range of questions for each core.
template <class Function>
void on_all_cores(std::size_t count, const Function& function) {
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < cores; ++i)
        threads.emplace_back([=] { function(count * i / cores, count * (i + 1) / cores, i); });
    for (std::thread& thread : threads) thread.join();
}

template <class Call>
std::vector<Answer> all_answers(const Call& call, const std::vector<Question>& asked) {
    std::vector<Answer> out(asked.size());
    on_all_cores(asked.size(), [&](std::size_t first, std::size_t last, std::size_t) {
        for (std::size_t i = first; i < last; ++i) out[i] = call(asked[i]);
    });
    return out;
}

} // namespace

std::vector<Question> questions(std::size_t count, unsigned batch, const acdf::File& file) {
    std::vector<Question> out(count);
    const AcdfVisibility* scene =
        file.kind() == ACDF_KIND_LOCAL ? acdf::visible_view(file).data().cells.header : nullptr;
    on_all_cores(count, [&](std::size_t first, std::size_t last, std::size_t core) {
        Random random(1000 * batch + core);
        for (std::size_t i = first; i < last; ++i) {
            Question& q = out[i];
            for (double& u : q.u) u = uniform(random);
            if (i % 2 == 0) // floats, as renderers sample them
                for (double& u : q.u) u = std::min(static_cast<double>(static_cast<float>(u)), 1.0 - 0x1p-24);
            unit_vector(random, -1.0, q.direction);
            unit_vector(random, -1.0, q.normal);
            unit_vector(random, 0.0, q.view);
            for (int k = 0; k < 3 && scene; ++k) // of scenes whose axes are the file's
                q.position[k] =
                    scene->low[k] + static_cast<float>(uniform(random)) * (scene->high[k] - scene->low[k]);
            if (file.kind() == ACDF_KIND_TABLE)
                for (std::uint32_t k = 0; k < file.table().sampled_count(); ++k) {
                    const AcdfAxis& axis = file.table().sampled_axis(k);
                    q.x[k] = axis.low + uniform(random) * (axis.high - axis.low);
                }
        }
    });
    return out;
}

std::vector<Answer> host_answers(const OfEnvironment& call, const std::vector<Question>& asked) {
    return all_answers(call, asked);
}
std::vector<Answer> host_answers(const OfLocal& call, const std::vector<Question>& asked) {
    return all_answers(call, asked);
}
std::vector<Answer> host_answers(const OfBrdf& call, const std::vector<Question>& asked) {
    return all_answers(call, asked);
}
std::vector<Answer> host_answers(const OfProduct& call, const std::vector<Question>& asked) {
    return all_answers(call, asked);
}
std::vector<Answer> host_answers(const OfTable& call, const std::vector<Question>& asked) {
    return all_answers(call, asked);
}

} // namespace acdf_cuda
