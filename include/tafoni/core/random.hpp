/// \file
/// Counter-based random streams: a draw depends on (seed, stage, index, position) and on nothing else.
#ifndef TAFONI_CORE_RANDOM_HPP
#define TAFONI_CORE_RANDOM_HPP

#include <tafoni/core/vector.hpp>

#include <array>
#include <cstdint>

namespace tafoni {

namespace detail {

/// Philox4x32-10 [Salmon et al. 2011, Parallel random numbers: as easy as 1, 2, 3]. O(1).
[[nodiscard]] constexpr std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> c,
                                                            std::array<std::uint32_t, 2> k) noexcept {
    for (int round = 0; round < 10; ++round) {
        std::uint64_t const p0 = 0xD2511F53ULL * c[0];
        std::uint64_t const p1 = 0xCD9E8D57ULL * c[2];
        c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ k[0], static_cast<std::uint32_t>(p1),
             static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ k[1], static_cast<std::uint32_t>(p0)};
        k[0] += 0x9E3779B9U;
        k[1] += 0xBB67AE85U;
    }
    return c;
}

}  // namespace detail

/// One stream of random bits for one decision maker: `stream(seed, stage, index)`.
///
/// Equal arguments give equal draws on every thread and machine; different arguments give
/// independent ones. A stream holds 2^33 draws. Copying it copies the position.
class stream {
public:
    constexpr stream(std::uint64_t seed, std::uint32_t stage, std::uint64_t index) noexcept
        : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
          counter_{0, stage, static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32)} {}

    /// 64 uniform bits. O(1), about 10 ns.
    [[nodiscard]] constexpr std::uint64_t bits() noexcept {
        if (!half_) {
            block_ = detail::philox(counter_, key_);
            ++counter_[0];
        }
        std::uint64_t const r = half_ ? std::uint64_t{block_[3]} << 32 | block_[2]
                                      : std::uint64_t{block_[1]} << 32 | block_[0];
        half_ = !half_;
        return r;
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    [[nodiscard]] constexpr double uniform01() noexcept { return static_cast<double>(bits() >> 11) * 0x1p-53; }

    /// Uniform in [lo, hi], lo <= hi; `hi` itself comes up by rounding only. hi - lo must be finite.
    [[nodiscard]] constexpr double uniform(double lo, double hi) noexcept { return lo + (hi - lo) * uniform01(); }

    /// Uniform in 0 .. n-1 without bias [Lemire 2019]; n > 0.
    [[nodiscard]] constexpr std::uint64_t index_below(std::uint64_t n) noexcept {
        __extension__ using wide = unsigned __int128;
        wide m = wide{bits()} * n;
        if (static_cast<std::uint64_t>(m) < n) {
            std::uint64_t const threshold = (0 - n) % n;
            while (static_cast<std::uint64_t>(m) < threshold) m = wide{bits()} * n;
        }
        return static_cast<std::uint64_t>(m >> 64);
    }

    /// True with probability p: never for p <= 0, always for p >= 1. One draw in either case.
    [[nodiscard]] constexpr bool chance(double p) noexcept { return uniform01() < p; }

    /// Uniform on the unit sphere, by rejection (no trigonometry).
    [[nodiscard]] vec3 unit_vector() noexcept {
        for (;;) {
            double const x = uniform(-1, 1);
            double const y = uniform(-1, 1);
            double const z = uniform(-1, 1);
            double const s = x * x + y * y + z * z;
            if (s > 1e-4 && s <= 1) {
                double const l = std::sqrt(s);
                return vec3{x / l, y / l, z / l};
            }
        }
    }

private:
    std::array<std::uint32_t, 2> key_;
    std::array<std::uint32_t, 4> counter_;
    std::array<std::uint32_t, 4> block_{};
    bool half_ = false;
};

/// The stages that draw, so that no two of them share a stream. Users take `stage::user` and above.
namespace stage {
inline constexpr std::uint32_t sites = 1;
inline constexpr std::uint32_t jitter = 2;
inline constexpr std::uint32_t rain = 3;
inline constexpr std::uint32_t entry = 4;
inline constexpr std::uint32_t flow = 5;
inline constexpr std::uint32_t absorption = 6;
inline constexpr std::uint32_t damage = 7;
inline constexpr std::uint32_t breakage = 8;
inline constexpr std::uint32_t user = 1u << 16;
}  // namespace stage

}  // namespace tafoni

#endif
