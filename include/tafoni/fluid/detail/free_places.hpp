/// \file
/// Where in an emitter there is room for a particle.
#ifndef TAFONI_FLUID_DETAIL_FREE_PLACES_HPP
#define TAFONI_FLUID_DETAIL_FREE_PLACES_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/emitter.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tafoni::detail {

/// The places of a lattice, a spacing apart in the middle of an emitter's box, and which of them are taken.
class free_places {
public:
    static constexpr double most = 16777216;

    /// O(places). \throws invalid_input  `size_overflow` for more than 2^24 places.
    free_places(box_emitter const& e, double spacing) : spacing_(spacing) {
        double total = 1;
        for (int d = 0; d < 3; ++d) {
            double const wide = e.box.hi[d] - e.box.lo[d];
            double const along = std::floor(wide / spacing + 1e-6) + 1;
            total *= along;
            if (!(total <= most)) {
                fail<invalid_input>(errc::size_overflow, "sph: an emitter has more than 2^24 places; its box is too large for the spacing",
                                    {.kind = entity::parameter, .value = total, .limit = most});
            }
            n_[static_cast<std::size_t>(d)] = static_cast<std::uint32_t>(along);
            first_[d] = e.box.lo[d] + 0.5 * (wide - spacing * (along - 1));
        }
    }

    void clear() { taken_.assign(static_cast<std::size_t>(n_[0]) * n_[1] * n_[2], 0); }

    /// Marks the places closer to `p` than a spacing, less a hundredth for those that have just moved on. O(1).
    void occupy(vec3 const& p) {
        std::array<std::uint32_t, 3> low{};
        std::array<std::uint32_t, 3> high{};
        for (std::size_t d = 0; d < 3; ++d) {
            double const at = (p[static_cast<int>(d)] - first_[static_cast<int>(d)]) / spacing_;
            if (!(at > -1 && at < n_[d])) return;
            low[d] = at < 0 ? 0 : static_cast<std::uint32_t>(at);
            high[d] = std::min(at < 0 ? 0 : low[d] + 1, n_[d] - 1);
        }
        for (std::uint32_t c = low[2]; c <= high[2]; ++c) {
            for (std::uint32_t b = low[1]; b <= high[1]; ++b) {
                for (std::uint32_t a = low[0]; a <= high[0]; ++a) {
                    if (squared_length(p - place(a, b, c)) < 0.98 * spacing_ * spacing_) {
                        taken_[number(a, b, c)] = 1;
                    }
                }
            }
        }
    }

    /// Calls `put(place)` for free ones, at most `wanted`: for all, x fastest, where there are no more than that, else for places
    /// spread evenly over the box, in a sequence that goes on from its `first`, so that it is even in time as well. O(places).
    template <class Put>
    void take(std::size_t wanted, std::uint64_t first, Put const& put) {
        std::size_t left = static_cast<std::size_t>(std::count(taken_.begin(), taken_.end(), static_cast<unsigned char>(0)));
        // Multiples of the powers of the root of x^4 = x + 1 fill a cube evenly [Roberts 2018].
        constexpr std::array<std::uint64_t, 3> stride{0xD1B54A32D192ED03ULL, 0xABC98388FB8FAC02ULL, 0x8CB92BA72F3D8DD7ULL};
        for (std::uint64_t k = first + 1, tries = 0; left > wanted && wanted > 0 && tries < 4 * taken_.size(); ++k, ++tries) {
            std::array<std::uint32_t, 3> at{};
            for (std::size_t d = 0; d < 3; ++d) at[d] = static_cast<std::uint32_t>(((k * stride[d] >> 32) * n_[d]) >> 32);
            unsigned char& taken = taken_[number(at[0], at[1], at[2])];
            if (taken != 0) continue;
            taken = 1;
            put(place(at[0], at[1], at[2]));
            --wanted;
            --left;
        }
        for (std::uint32_t c = 0; c < n_[2]; ++c) {
            for (std::uint32_t b = 0; b < n_[1]; ++b) {
                for (std::uint32_t a = 0; a < n_[0] && wanted > 0; ++a) {
                    if (taken_[number(a, b, c)] != 0) continue;
                    put(place(a, b, c));
                    --wanted;
                }
            }
        }
    }

private:
    [[nodiscard]] vec3 place(std::uint32_t a, std::uint32_t b, std::uint32_t c) const noexcept {
        return vec3{first_[0] + spacing_ * a, first_[1] + spacing_ * b, first_[2] + spacing_ * c};
    }

    [[nodiscard]] std::size_t number(std::uint32_t a, std::uint32_t b, std::uint32_t c) const noexcept {
        return a + static_cast<std::size_t>(n_[0]) * (b + static_cast<std::size_t>(n_[1]) * c);
    }

    double spacing_;
    vec3 first_{0, 0, 0};
    std::array<std::uint32_t, 3> n_{};
    std::vector<unsigned char> taken_{};
};

}  // namespace tafoni::detail

#endif
