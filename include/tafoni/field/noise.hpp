/// \file
/// Gradient noise: smooth, band-limited, the same bits everywhere.
#ifndef TAFONI_FIELD_NOISE_HPP
#define TAFONI_FIELD_NOISE_HPP

#include <tafoni/core/error.hpp>
#include <tafoni/field/concepts.hpp>

#include <array>
#include <cstdint>

namespace tafoni {

/// The value of a field and its gradient at one point.
struct noise_sample {
    double value = 0;
    vec3 gradient{0, 0, 0};  ///< per length unit
};

/// Gradient noise on the integer lattice of `frequency * p` [Perlin 2002, Improving Noise], with
/// hashed edge directions, C2-smooth.
///
/// In [-1, 1] (the classic sum divided by its largest possible value), 0 on the lattice, mean 0;
/// |noise(p) - noise(q)| <= 4 frequency |p - q|. Points whose scaled coordinates reach 2^51 are taken
/// as lattice points. Models `scalar_field`.
struct gradient_noise {
    std::uint64_t seed = 0;
    double frequency = 1;                       ///< lattice cells per length unit, >= 0
    std::array<std::uint32_t, 3> period{0, 0, 0};  ///< repeats after so many lattice cells; 0 = never

    /// In [-1, 1]. O(1), about 0.1 us.
    [[nodiscard]] double operator()(vec3 const& p) const noexcept { return evaluate<false>(p).value; }

    /// Value and analytic gradient. O(1).
    [[nodiscard]] noise_sample sample(vec3 const& p) const noexcept { return evaluate<true>(p); }

    /// \throws invalid_input  if `frequency` is negative or not finite.
    void validate() const { detail::require_range("gradient_noise.frequency", frequency, 0, 1e300); }

private:
    static constexpr double largest_sum = 1.0364;  // max over a cell of sum of weights times longest projection

    [[nodiscard]] static constexpr std::uint64_t mix(std::uint64_t h) noexcept {
        h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ULL;  // finalizer of splitmix64 [Steele et al. 2014]
        h = (h ^ (h >> 27)) * 0x94D049BB133111EBULL;
        return h ^ (h >> 31);
    }

    [[nodiscard]] static std::uint64_t wrapped(std::int64_t i, std::uint32_t n) noexcept {
        if (n == 0) return static_cast<std::uint64_t>(i);
        std::int64_t const r = i % static_cast<std::int64_t>(n);
        return static_cast<std::uint64_t>(r < 0 ? r + static_cast<std::int64_t>(n) : r);
    }

    template <bool WithGradient>
    [[nodiscard]] noise_sample evaluate(vec3 const& p) const noexcept {
        std::uint64_t lattice[3][2];
        double offset[3][2];
        double weight[3][2];
        double slope[3];
        for (int a = 0; a < 3; ++a) {
            double const u = p[a] * frequency;
            if (!(std::fabs(u) < 0x1p51)) return {};
            double const cell = std::floor(u);
            double const t = u - cell;
            auto const i = static_cast<std::int64_t>(cell);
            auto const axis = static_cast<std::size_t>(a);
            lattice[a][0] = wrapped(i, period[axis]);
            lattice[a][1] = wrapped(i + 1, period[axis]);
            offset[a][0] = t;
            offset[a][1] = t - 1;
            weight[a][1] = t * t * t * (t * (t * 6 - 15) + 10);
            weight[a][0] = 1 - weight[a][1];
            slope[a] = 30 * t * t * (t - 1) * (t - 1);
        }
        noise_sample sum;
        for (int i = 0; i < 2; ++i) {
            std::uint64_t const hx = mix(seed + 0x9E3779B97F4A7C15ULL * (lattice[0][i] + 1));
            for (int j = 0; j < 2; ++j) {
                std::uint64_t const hy = mix(hx + 0x9E3779B97F4A7C15ULL * (lattice[1][j] + 1));
                for (int k = 0; k < 2; ++k) {
                    std::uint64_t const h = mix(hy + 0x9E3779B97F4A7C15ULL * (lattice[2][k] + 1));
                    vec3 const g = direction(h);
                    double const along = g[0] * offset[0][i] + g[1] * offset[1][j] + g[2] * offset[2][k];
                    double const w = weight[0][i] * weight[1][j] * weight[2][k];
                    sum.value += w * along;
                    if constexpr (WithGradient) {
                        double const sx = (i != 0 ? slope[0] : -slope[0]) * weight[1][j] * weight[2][k];
                        double const sy = (j != 0 ? slope[1] : -slope[1]) * weight[0][i] * weight[2][k];
                        double const sz = (k != 0 ? slope[2] : -slope[2]) * weight[0][i] * weight[1][j];
                        sum.gradient[0] += w * g[0] + sx * along;
                        sum.gradient[1] += w * g[1] + sy * along;
                        sum.gradient[2] += w * g[2] + sz * along;
                    }
                }
            }
        }
        sum.value /= largest_sum;
        if constexpr (WithGradient) {
            for (int a = 0; a < 3; ++a) sum.gradient[a] = sum.gradient[a] / largest_sum * frequency;
        }
        return sum;
    }

    /// One of the twelve directions from the centre of a cube to its edges.
    [[nodiscard]] static vec3 direction(std::uint64_t h) noexcept {
        double const a = (h & 1) != 0 ? 1.0 : -1.0;
        double const b = (h & 2) != 0 ? 1.0 : -1.0;
        switch (((h >> 32) * 3) >> 32) {
            case 0: return vec3{0, a, b};
            case 1: return vec3{a, 0, b};
            default: return vec3{a, b, 0};
        }
    }
};

static_assert(scalar_field<gradient_noise>);

}  // namespace tafoni

#endif
