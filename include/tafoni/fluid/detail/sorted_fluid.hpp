/// \file
/// What particles do to each other: sorted by cell, summed over neighbours, handed back by number.
#ifndef TAFONI_FLUID_DETAIL_SORTED_FLUID_HPP
#define TAFONI_FLUID_DETAIL_SORTED_FLUID_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/fluid/detail/particle_grid.hpp>
#include <tafoni/fluid/detail/sph_sums_avx2.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tafoni::detail {

/// Numbers of particles along x, y and z.
template <class Scalar>
using fluid_axes = std::array<std::vector<Scalar>, 3>;

/// In units of h and seconds.
struct fluid_constants {
    double mass = 0;       ///< of a particle times the kernel's factor, over the density at rest
    double stiffness = 0;  ///< square of the speed of sound, pressure over density
    double viscosity = 0;  ///< 20 times the kinematic one
};

/// Keeps its memory from step to step; holds nothing else that the next step depends on.
template <class Scalar>
class sorted_fluid {
public:
    /// Densities, and accelerations by pressure and viscosity. O(particles x neighbours + cells).
    /// \throws invalid_input  as `particle_grid::build`.
    template <executor E>
    void accelerate(fluid_axes<Scalar> const& x, fluid_axes<Scalar> const& v, fluid_constants const& c, fluid_axes<Scalar>& a,
                    std::vector<Scalar>& density, E const& threads) {
        std::size_t const n = x[0].size();
        for (auto& e : a) e.resize(n);
        grid_.build(x[0], x[1], x[2], threads);
        sort(x, v, threads);
        bool const avx2 = sph_has_avx2();
        sph_arrays<Scalar> const all{
            .x = x_[0].data(), .y = x_[1].data(), .z = x_[2].data(), .u = v_[0].data(), .v = v_[1].data(), .w = v_[2].data(),
            .density = density_.data(), .pressure = pressure_.data(), .spans = spans_.data(),
            .ax = a_[0].data(), .ay = a_[1].data(), .az = a_[2].data()};
        threads.for_blocks(n, particle_grain, [&](std::size_t from, std::size_t to) {
            sph_densities(all, from, to, static_cast<Scalar>(c.mass), avx2);
            auto const stiff = static_cast<Scalar>(c.stiffness);
            for (std::size_t k = from; k < to; ++k) {
                Scalar const rho = density_[k];
                pressure_[k] = rho > 1 ? stiff * (rho - 1) / (rho * rho) : Scalar(0);
            }
        });
        threads.for_blocks(n, particle_grain, [&](std::size_t from, std::size_t to) {
            sph_forces(all, from, to, static_cast<Scalar>(c.mass), static_cast<Scalar>(c.viscosity), avx2);
            for (std::size_t k = from; k < to; ++k) {
                std::size_t const i = order()[k];
                density[i] = density_[k];
                for (std::size_t d = 0; d < 3; ++d) a[d][i] = a_[d][k];
            }
        });
    }

    /// Sorted place -> number of the particle, of the last `accelerate`.
    [[nodiscard]] std::span<std::uint32_t const> order() const noexcept { return grid_.order(); }

private:
    static constexpr std::size_t pad = sph_lane_count<Scalar>;

    template <executor E>
    void sort(fluid_axes<Scalar> const& x, fluid_axes<Scalar> const& v, E const& threads) {
        std::size_t const n = x[0].size();
        for (std::size_t d = 0; d < 3; ++d) {
            for (auto* t : {&x_[d], &v_[d], &a_[d]}) t->resize(n + pad);
        }
        for (auto* t : {&density_, &pressure_}) t->resize(n + pad);
        for (auto* t : {&x_[0], &x_[1], &x_[2], &v_[0], &v_[1], &v_[2], &density_, &pressure_}) {
            std::fill(t->end() - pad, t->end(), Scalar(0));
        }
        spans_.resize(n);
        threads.for_blocks(n, particle_grain, [&](std::size_t from, std::size_t to) {
            for (std::size_t k = from; k < to; ++k) {
                std::size_t const i = order()[k];
                for (std::size_t d = 0; d < 3; ++d) {
                    x_[d][k] = x[d][i];
                    v_[d][k] = v[d][i];
                }
                grid_.around(x_[0][k], x_[1][k], x_[2][k], spans_[k]);
            }
        });
    }

    particle_grid<Scalar> grid_{};
    fluid_axes<Scalar> x_{};
    fluid_axes<Scalar> v_{};
    fluid_axes<Scalar> a_{};
    std::vector<Scalar> density_{};
    std::vector<Scalar> pressure_{};
    std::vector<sph_spans> spans_{};
};

}  // namespace tafoni::detail

#endif
