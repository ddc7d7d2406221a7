/// \file
/// Numbers from the bytes of a file, little end first.
#ifndef TAFONI_IO_DETAIL_LOAD_LITTLE_HPP
#define TAFONI_IO_DETAIL_LOAD_LITTLE_HPP

#include <cstddef>
#include <cstdint>

namespace tafoni::detail {

/// An unsigned number of `sizeof(T)` bytes, little end first.
template <class T>
[[nodiscard]] T load_little(char const* at) noexcept {
    T value = 0;
    for (std::size_t k = 0; k < sizeof(T); ++k) {
        value = static_cast<T>(value | static_cast<T>(static_cast<T>(static_cast<unsigned char>(at[k])) << (8 * k)));
    }
    return value;
}

}  // namespace tafoni::detail

#endif
