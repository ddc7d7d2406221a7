/// \file
/// Vectors of a fixed number of lanes, so that sums round alike whatever the machine's own width is.
#ifndef TAFONI_FLUID_DETAIL_SPH_LANES_HPP
#define TAFONI_FLUID_DETAIL_SPH_LANES_HPP

#include <cstddef>
#include <cstdint>

namespace tafoni::detail {

template <class Scalar>
struct sph_lanes;

template <>
struct sph_lanes<float> {
    static constexpr std::size_t count = 8;
    using value = float __attribute__((vector_size(32)));
    using word = std::int32_t;
    using mask = std::int32_t __attribute__((vector_size(32)));
};

template <>
struct sph_lanes<double> {
    static constexpr std::size_t count = 4;
    using value = double __attribute__((vector_size(32)));
    using word = std::int64_t;
    using mask = std::int64_t __attribute__((vector_size(32)));
};

/// A vector at any address.
template <class Vector>
struct __attribute__((packed, may_alias)) sph_loose {
    Vector lanes;
};

/// All ones, then all zeros: read from `count - n` on, the first n lanes are set.
template <class Scalar>
struct sph_tail {
    using word = typename sph_lanes<Scalar>::word;
    static constexpr std::size_t count = sph_lanes<Scalar>::count;
    word words[2 * count];
    constexpr sph_tail() : words{} {
        for (std::size_t k = 0; k < count; ++k) words[k] = -1;
    }
};
template <class Scalar>
inline constexpr sph_tail<Scalar> sph_tails{};

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

/// Sorted particles, in units of h and seconds. Arrays hold `count` lanes of zeros behind the last.
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
