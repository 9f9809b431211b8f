// Loops over the threads of an arena. Of each loop the templates of oneTBB make some forty functions; these make
// one.
#pragma once

#include <cstddef>

namespace acdf::compress {

/// A reference to what can be called with (std::size_t first, std::size_t last).
class PartBody {
public:
    template <class Body>
    PartBody(const Body& body) // NOLINT(google-explicit-constructor): as a parameter takes a lambda
        : body_(&body), call_([](const void* of, std::size_t first, std::size_t last) {
              (*static_cast<const Body*>(of))(first, last);
          }) {}
    void operator()(std::size_t first, std::size_t last) const { call_(body_, first, last); }

private:
    const void* body_;
    void (*call_)(const void*, std::size_t, std::size_t);
};

/// Calls `body` for parts of [begin, end), none of which is halved once it is down to `grain`. What it throws is
/// thrown here.
void parallel_parts(std::size_t begin, std::size_t end, std::size_t grain, const PartBody& body);

/// Calls body(i) for each i of [begin, end), neither of them below 0.
template <class Index, class Body>
void parallel_for(Index begin, Index end, const Body& body) {
    if (!(begin < end)) return;
    parallel_parts(static_cast<std::size_t>(begin), static_cast<std::size_t>(end), 1,
                   [&](std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) body(static_cast<Index>(i));
                   });
}

} // namespace acdf::compress
