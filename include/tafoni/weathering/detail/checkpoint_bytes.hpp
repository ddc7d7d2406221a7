/// \file
/// What the checkpoints of all processes are written with.
#ifndef TAFONI_WEATHERING_DETAIL_CHECKPOINT_BYTES_HPP
#define TAFONI_WEATHERING_DETAIL_CHECKPOINT_BYTES_HPP

#include <tafoni/core/detail/bytes.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace tafoni::detail {

/// What tells two policies apart without help of the compiler's names, which differ between compilers.
/// An empty policy has a size of 1 and no bytes that say anything.
template <class Policy>
void add_policy(number_hash& h, Policy const& policy) {
    if constexpr (requires { policy.parameters(); }) {
        for (double const v : policy.parameters()) h.add(v);
    } else if constexpr (std::is_trivially_copyable_v<Policy> && std::has_unique_object_representations_v<Policy> &&
                         !std::is_empty_v<Policy>) {
        for (auto const byte : std::bit_cast<std::array<unsigned char, sizeof(Policy)>>(policy)) {
            h.add(std::uint64_t{byte});
        }
    }
    if constexpr (requires { std::string_view(Policy::name); }) {
        for (char const c : std::string_view(Policy::name)) h.add(std::uint64_t{static_cast<unsigned char>(c)});
    } else {
        h.add(std::uint64_t{sizeof(Policy)});
    }
    h.add(std::uint64_t{0x5EA});
}

}  // namespace tafoni::detail

#endif
