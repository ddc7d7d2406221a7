/// \file
/// Arrays for sums over neighbours in a fixed number of lanes, so that they round alike whatever width a machine has.
#ifndef TAFONI_FLUID_DETAIL_SPH_LANES_HPP
#define TAFONI_FLUID_DETAIL_SPH_LANES_HPP

#include <cstddef>
#include <cstdint>

namespace tafoni::detail {

/// Lanes of every sum: 8 of float, 4 of double.
template <class Scalar>
inline constexpr std::size_t sph_lane_count = 32 / sizeof(Scalar);

/// All ones, then all zeros: read from `sph_lane_count - n` on, the first n lanes are set.
template <class Word>
struct sph_tail {
    static constexpr std::size_t count = sph_lane_count<Word>;
    Word words[2 * count];
    constexpr sph_tail() : words{} {
        for (std::size_t k = 0; k < count; ++k) words[k] = -1;
    }
};
template <class Word>
inline constexpr sph_tail<Word> sph_tails{};

/// A stretch of sorted particles that may be near.
struct sph_span {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};
/// The stretches around one particle: one for each row of cells.
struct sph_spans {
    sph_span row[9];
    std::uint32_t count = 0;
};

/// Sorted particles, in units of h and seconds. Arrays that are read hold `sph_lane_count` zeros behind the last.
template <class Scalar>
struct sph_arrays {
    Scalar const* x = nullptr;
    Scalar const* y = nullptr;
    Scalar const* z = nullptr;
    Scalar const* u = nullptr;
    Scalar const* v = nullptr;
    Scalar const* w = nullptr;
    Scalar* density = nullptr;   ///< over that at rest
    Scalar* pressure = nullptr;  ///< p / density^2
    sph_spans const* spans = nullptr;
    Scalar* ax = nullptr;
    Scalar* ay = nullptr;
    Scalar* az = nullptr;
};

}  // namespace tafoni::detail

#endif
