// What is done to a file, by the hundred.
#pragma once

#include <functional>
#include <type_traits>

namespace acdf_test {

/// std::function, for which each type that it is made from costs some forty functions to compile: of lambdas that
/// capture nothing, which are hundreds, the pointer is kept instead, and that is one type.
template <class Signature>
class Action : public std::function<Signature> {
public:
    Action() = default;
    template <class F, class = std::enable_if_t<std::is_constructible_v<std::function<Signature>, F>>>
    Action(F f) : std::function<Signature>(kept(f)) {}

private:
    template <class F>
    static auto kept(const F& f) {
        if constexpr (std::is_convertible_v<F, Signature*>) return static_cast<Signature*>(f);
        else return f;
    }
};

} // namespace acdf_test
