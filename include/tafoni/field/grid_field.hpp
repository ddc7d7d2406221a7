/// \file
/// A field sampled on a regular grid that the user owns.
#ifndef TAFONI_FIELD_GRID_FIELD_HPP
#define TAFONI_FIELD_GRID_FIELD_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>
#include <tafoni/field/detail/mix.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

namespace tafoni {

/// Trilinear interpolation of samples at origin + (i, j, k) spacing; beyond the grid the nearest
/// sample of its border holds. Within the range of the samples. The samples are viewed, not copied:
/// they must outlive the field. Models `scalar_field`.
template <class Sample = float>
    requires std::is_arithmetic_v<Sample>
struct grid_field {
    std::span<Sample const> samples{};        ///< x runs fastest: sample (i, j, k) at i + size[0] (j + size[1] k)
    std::array<std::size_t, 3> size{0, 0, 0}; ///< samples along x, y, z, >= 1
    vec3 origin{0, 0, 0};                     ///< of sample (0, 0, 0)
    vec3 spacing{1, 1, 1};                    ///< > 0, length unit

    /// Expects what `validate` asks for. O(1).
    [[nodiscard]] double operator()(vec3 const& p) const noexcept {
        std::array<std::size_t, 3> low;
        std::array<std::size_t, 3> high;
        std::array<double, 3> t;
        for (std::size_t a = 0; a < 3; ++a) {
            auto const axis = static_cast<Eigen::Index>(a);
            auto const last = static_cast<double>(size[a] - 1);
            double u = (p[axis] - origin[axis]) / spacing[axis];
            u = u > 0 ? (u < last ? u : last) : 0.0;
            double const cell = std::floor(u);
            low[a] = static_cast<std::size_t>(cell);
            high[a] = low[a] + 1 < size[a] ? low[a] + 1 : low[a];
            t[a] = u - cell;
        }
        auto const along_x = [&](std::size_t j, std::size_t k) {
            return detail::mix(at(low[0], j, k), at(high[0], j, k), t[0]);
        };
        double const below = detail::mix(along_x(low[1], low[2]), along_x(high[1], low[2]), t[1]);
        double const above = detail::mix(along_x(low[1], high[2]), along_x(high[1], high[2]), t[1]);
        return detail::mix(below, above, t[2]);
    }

    /// \throws invalid_input  if sizes do not fit the samples, a spacing is not positive or a sample not finite.
    void validate() const {
        __extension__ using wide = unsigned __int128;
        wide product = 1;
        for (std::size_t const n : size) {
            if (n > 0xFFFFFFFFU) {
                detail::fail<invalid_input>(errc::size_overflow, "grid_field.size: got " + std::to_string(n),
                                            {.kind = entity::parameter, .value = static_cast<double>(n)});
            }
            product *= n;
        }
        if (product == 0 || product != samples.size()) {
            detail::fail<invalid_input>(errc::attribute_length,
                                        "grid_field.samples: got " + std::to_string(samples.size()) + " for a grid of " +
                                            std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
                                            std::to_string(size[2]),
                                        {.kind = entity::parameter});
        }
        for (int a = 0; a < 3; ++a) {
            detail::require_range("grid_field.origin", origin[a], -1e300, 1e300);
            detail::require_range("grid_field.spacing", spacing[a], 1e-300, 1e300);
        }
        for (std::size_t i = 0; i < samples.size(); ++i) {
            auto const v = static_cast<double>(samples[i]);
            if (!std::isfinite(v)) {
                detail::fail<invalid_input>(errc::bad_parameter,
                                            "grid_field.samples: sample " + std::to_string(i) + " is not finite",
                                            {.kind = entity::voxel, .index = i, .value = v});
            }
        }
    }

private:
    [[nodiscard]] double at(std::size_t i, std::size_t j, std::size_t k) const noexcept {
        return static_cast<double>(samples[i + size[0] * (j + size[1] * k)]);
    }
};

static_assert(scalar_field<grid_field<float>>);

}  // namespace tafoni

#endif
