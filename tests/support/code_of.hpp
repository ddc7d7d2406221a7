/// \file
/// What a refused call is refused with.
#ifndef TAFONI_TESTS_SUPPORT_CODE_OF_HPP
#define TAFONI_TESTS_SUPPORT_CODE_OF_HPP

#include <tafoni/core/error.hpp>

namespace tafoni_test {

/// The code of the Error that `f` throws; errc{} where it throws none.
template <class Error = tafoni::invalid_input, class F>
[[nodiscard]] tafoni::errc code_of(F const& f) {
    try {
        f();
    } catch (Error const& e) {
        return e.code();
    }
    return tafoni::errc{};
}

}  // namespace tafoni_test

#endif
