// Loops of objects that are made once and used again: of the calling thread alone, which takes no memory, or of the
// arena that it is in.
#pragma once

#include <cstddef>

namespace acdf::compress {

class Loop {
public:
    explicit Loop(bool alone) : alone_(alone) {}

    /// How many threads may call a body at once.
    std::size_t slots() const;

    /// Calls body(first, last, slot) for parts of [0, count) of about `grain`; no two at once with the same slot.
    template <class Body>
    void run(std::size_t count, std::size_t grain, const Body& body) const {
        if (count == 0) return;
        if (alone_ || count <= grain) return body(std::size_t{0}, count, std::size_t{0});
        share(count, grain, &body, [](const void* of, std::size_t first, std::size_t last, std::size_t slot) {
            (*static_cast<const Body*>(of))(first, last, slot);
        });
    }

private:
    using Call = void (*)(const void*, std::size_t, std::size_t, std::size_t);
    static void share(std::size_t count, std::size_t grain, const void* body, Call call);

    bool alone_;
};

} // namespace acdf::compress
