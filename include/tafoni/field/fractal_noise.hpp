/// \file
/// Gradient noise of several scales, summed.
#ifndef TAFONI_FIELD_FRACTAL_NOISE_HPP
#define TAFONI_FIELD_FRACTAL_NOISE_HPP

#include <tafoni/field/noise.hpp>

namespace tafoni {

/// sum gain^k noise_k(frequency lacunarity^k p) / sum gain^k, k = 0 .. octaves - 1.
///
/// In [-1, 1]; 0 without octaves. Octaves draw from different lattices. Models `scalar_field`.
struct fractal_noise {
    std::uint64_t seed = 0;
    double frequency = 1;   ///< of the first octave, lattice cells per length unit, >= 0
    unsigned octaves = 5;   ///< 0 .. 64
    double lacunarity = 2;  ///< factor of the frequency from octave to octave, 1 .. 16
    double gain = 0.5;      ///< factor of the amplitude from octave to octave, 0 .. 1

    /// In [-1, 1]. O(octaves).
    [[nodiscard]] double operator()(vec3 const& p) const noexcept {
        double sum = 0;
        each_octave([&](gradient_noise const& n, double share) { sum += share * n(p); });
        return sum;
    }

    /// Value and analytic gradient. O(octaves).
    [[nodiscard]] noise_sample sample(vec3 const& p) const noexcept {
        noise_sample sum;
        each_octave([&](gradient_noise const& n, double share) {
            noise_sample const s = n.sample(p);
            sum.value += share * s.value;
            for (int a = 0; a < 3; ++a) sum.gradient[a] += share * s.gradient[a];
        });
        return sum;
    }

    /// \throws invalid_input  if a parameter lies outside its range.
    void validate() const {
        detail::require_range("fractal_noise.frequency", frequency, 0, 1e300);
        detail::require_range("fractal_noise.octaves", octaves, 0, 64);
        detail::require_range("fractal_noise.lacunarity", lacunarity, 1, 16);
        detail::require_range("fractal_noise.gain", gain, 0, 1);
    }

private:
    template <class F>
    void each_octave(F const& f) const noexcept {
        unsigned const n = octaves < 64 ? octaves : 64;
        double total = 0;
        double amplitude = 1;
        for (unsigned k = 0; k < n; ++k, amplitude *= gain) total += amplitude;
        amplitude = 1;
        double scaled = frequency;
        for (unsigned k = 0; k < n; ++k, amplitude *= gain, scaled *= lacunarity) {
            // Past 2^1000 (and for NaN) an octave has no finite lattice; its share is zero everywhere.
            if (!(scaled < 0x1p1000)) return;
            f(gradient_noise{.seed = seed + 0xD1B54A32D192ED03ULL * k, .frequency = scaled}, amplitude / total);
        }
    }
};

static_assert(scalar_field<fractal_noise>);

}  // namespace tafoni

#endif
