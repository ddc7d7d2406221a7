/// \file
/// Smoothed particle hydrodynamics: a weakly compressible fluid of particles.
#ifndef TAFONI_FLUID_SPH_HPP
#define TAFONI_FLUID_SPH_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/concepts.hpp>
#include <tafoni/fluid/detail/particle_grid.hpp>
#include <tafoni/fluid/detail/sph_sums_avx2.hpp>
#include <tafoni/fluid/emitter.hpp>
#include <tafoni/fluid/sph_options.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tafoni {

/// A particle as a user places it.
struct fluid_particle {
    std::uint64_t id = 0;
    vec3 position{0, 0, 0};  ///< length unit
    vec3 velocity{0, 0, 0};  ///< length unit / s
};

/// Weakly compressible SPH with the cubic spline [Monaghan 1992, 2005], in float or double.
///
/// rho_i = sum m W(x_i - x_j), the particle itself included; p = c^2 max(rho - rho_0, 0); accelerations
/// -sum m (p_i / rho_i^2 + p_j / rho_j^2 + viscosity) grad W, walls by k_s d - k_d (v . n) along the normal with
/// d = reach - distance [thesis, equation 8.1 with the erratum]; velocities first, then positions. The step is courant
/// times the least of h / (c + v), sqrt(h / a), h^2 / (4 nu), 1 / sqrt(k_s) and 1 / k_d, at most `largest_step`.
/// An emitter puts a particle on each place of its lattice that is free as long as there may be more; the sink takes
/// away what leaves its box. The sums over neighbours run by cell and id in fixed lanes: the state depends on
/// particles and ids only, not on threads, instruction set or the order in which particles were given.
/// Models `particle_fluid`.
template <std::floating_point Scalar>
class sph {
public:
    /// Emitters start to run with the first step. O(places in the emitters).
    /// \throws invalid_input  `bad_parameter`, `bad_box`, `size_overflow` for more than 2^24 places in an emitter.
    sph(std::vector<box_emitter> emitters, box_sink const& sink, sph_options const& options = {})
        : options_((options.validate(), options)), sink_((sink.validate(), sink)), emitters_(std::move(emitters)) {
        for (box_emitter const& e : emitters_) {
            e.validate();
            (void)lattice(e);
        }
        h_ = options_.smoothing * options_.spacing;
        sound_ = options_.sound_speed > 0 ? options_.sound_speed : 10 * fastest();
        detail::require_range("sph_options.sound_speed (without gravity or speed from an emitter it must be given)", sound_, 1e-100, 1e100);
        reach_ = options_.reach > 0 ? options_.reach : options_.spacing;
        double const pace = sound_ / (5 * reach_);
        stiffness_ = options_.wall_stiffness > 0 ? options_.wall_stiffness : pace * pace;
        damping_ = options_.wall_damping > 0 ? options_.wall_damping : pace;
        viscosity_ = options_.viscosity + options_.damping * h_ * sound_ / 10;
        if (!emitters_.empty()) origin_ = emitters_[0].box.lo;
    }
    sph(box_emitter const& emitter, box_sink const& sink, sph_options const& options = {})
        : sph(std::vector<box_emitter>{emitter}, sink, options) {}

    /// Replaces all particles. O(n log n). \throws invalid_input  `non_finite_vertex` with the place in `all`;
    /// `bad_parameter` for an id that is given twice; `size_overflow` for more than `options.particles`.
    void place(std::span<fluid_particle const> all) {
        if (all.size() > options_.particles) {
            detail::fail<invalid_input>(errc::size_overflow, "sph.place: more particles than sph_options.particles",
                                        {.value = static_cast<double>(all.size()), .limit = static_cast<double>(options_.particles)});
        }
        std::vector<fluid_particle> sorted(all.begin(), all.end());
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            if (is_finite(sorted[i].position) && is_finite(sorted[i].velocity)) continue;
            detail::fail<invalid_input>(errc::non_finite_vertex, "sph.place: particle " + std::to_string(i) + " is not finite",
                                        {.kind = entity::vertex, .index = i});
        }
        std::sort(sorted.begin(), sorted.end(), [](auto const& a, auto const& b) { return a.id < b.id; });
        for (std::size_t i = 1; i < sorted.size(); ++i) {
            if (sorted[i].id != sorted[i - 1].id) continue;
            detail::fail<invalid_input>(errc::bad_parameter, "sph.place: id " + std::to_string(sorted[i].id) + " is given twice",
                                        {.kind = entity::parameter, .value = static_cast<double>(sorted[i].id)});
        }
        resize(0);
        ids_.clear();
        if (emitters_.empty() && !sorted.empty()) origin_ = sorted[0].position;
        for (fluid_particle const& p : sorted) append(p.id, p.position, p.velocity);
        next_id_ = sorted.empty() ? 0 : sorted.back().id + 1;
    }

    [[nodiscard]] std::size_t particle_count() const noexcept { return ids_.size(); }
    [[nodiscard]] vec3 position(std::size_t i) const noexcept {
        return vec3{origin_[0] + h_ * static_cast<double>(x_[0][i]), origin_[1] + h_ * static_cast<double>(x_[1][i]),
                    origin_[2] + h_ * static_cast<double>(x_[2][i])};
    }
    [[nodiscard]] vec3 velocity(std::size_t i) const noexcept {
        return vec3{h_ * static_cast<double>(v_[0][i]), h_ * static_cast<double>(v_[1][i]), h_ * static_cast<double>(v_[2][i])};
    }
    /// Ascending in i; no id is ever used again.
    [[nodiscard]] std::uint64_t id(std::size_t i) const noexcept { return ids_[i]; }
    /// At the start of the last step, over that at rest; 0 for a particle that has not made one.
    [[nodiscard]] double density(std::size_t i) const noexcept { return static_cast<double>(density_[i]); }
    [[nodiscard]] double reach() const noexcept { return reach_; }
    [[nodiscard]] double sound_speed() const noexcept { return sound_; }
    [[nodiscard]] sph_options const& options() const noexcept { return options_; }

    /// One step. O(particles x neighbours + cells). \throws invalid_input  `size_overflow` where particles pile up on a
    /// point, `out_of_range` where an acceleration is no number; the particles have not moved then.
    template <fluid_boundary B, executor E>
    double step(B const& walls, E const& threads) {
        emit();
        std::size_t const n = ids_.size();
        if (n == 0) return options_.largest_step;
        grid_.build(x_[0], x_[1], x_[2], threads);
        sort(threads);
        sum(threads);
        std::vector<extremes> blocks((n + detail::particle_grain - 1) / detail::particle_grain);
        threads.for_blocks(n, detail::particle_grain, [&](std::size_t from, std::size_t to) {
            blocks[from / detail::particle_grain] = add_forces(walls, from, to);
        });
        extremes all;
        for (extremes const& b : blocks) {
            all.velocity = std::max(all.velocity, b.velocity);
            all.acceleration = std::max(all.acceleration, b.acceleration);
            all.finite = all.finite && b.finite;
        }
        double const dt = time_step(all);
        threads.for_blocks(n, detail::particle_grain, [&](std::size_t from, std::size_t to) {
            for (std::size_t d = 0; d < 3; ++d) {
                for (std::size_t i = from; i < to; ++i) {
                    v_[d][i] += static_cast<Scalar>(dt) * a_[d][i];
                    x_[d][i] += static_cast<Scalar>(dt) * v_[d][i];
                }
            }
        });
        drain();
        return dt;
    }

private:
    static constexpr double pi = 3.14159265358979323846;
    static constexpr std::size_t pad = detail::sph_lane_count<Scalar>;
    using triple = std::array<std::vector<Scalar>, 3>;

    struct extremes {
        double velocity = 0;      ///< largest square, h^2 / s^2
        double acceleration = 0;  ///< largest square, h^2 / s^4
        bool finite = true;
    };

    /// Of the fall through a pool, or out of an emitter.
    [[nodiscard]] double fastest() const noexcept {
        double const g = std::max(length(options_.gravity), std::fabs(options_.toward));
        double square = 2 * g * 16 * options_.spacing;
        for (box_emitter const& e : emitters_) square = std::max(square, squared_length(e.velocity));
        return std::sqrt(square);
    }

    void resize(std::size_t n) {
        for (triple* t : {&x_, &v_}) {
            for (auto& a : *t) a.resize(n);
        }
        density_.resize(n, Scalar(0));
    }
    void append(std::uint64_t id, vec3 const& p, vec3 const& v) {
        ids_.push_back(id);
        for (int d = 0; d < 3; ++d) {
            auto const e = static_cast<std::size_t>(d);
            x_[e].push_back(static_cast<Scalar>((p[d] - origin_[d]) / h_));
            v_[e].push_back(static_cast<Scalar>(v[d] / h_));
        }
        density_.push_back(Scalar(0));
    }

    /// Places of an emitter along each axis, a spacing apart, in the middle of its box.
    [[nodiscard]] std::array<std::uint32_t, 3> lattice(box_emitter const& e) const {
        std::array<std::uint32_t, 3> n{};
        double total = 1;
        for (int d = 0; d < 3; ++d) {
            double const along = std::floor((e.box.hi[d] - e.box.lo[d]) / options_.spacing + 1e-6) + 1;
            total *= along;
            if (!(total <= 16777216)) {
                detail::fail<invalid_input>(errc::size_overflow, "sph: an emitter has more than 2^24 places; its box is too large for the spacing",
                                            {.kind = entity::parameter, .value = total, .limit = 16777216});
            }
            n[static_cast<std::size_t>(d)] = static_cast<std::uint32_t>(along);
        }
        return n;
    }

    void emit() {
        double const s = options_.spacing;
        for (box_emitter const& e : emitters_) {
            if (ids_.size() >= options_.particles) return;
            auto const n = lattice(e);
            vec3 first{0, 0, 0};
            for (int d = 0; d < 3; ++d) {
                first[d] = e.box.lo[d] + 0.5 * ((e.box.hi[d] - e.box.lo[d]) - s * (n[static_cast<std::size_t>(d)] - 1));
            }
            taken_.assign(static_cast<std::size_t>(n[0]) * n[1] * n[2], 0);
            for (std::size_t i = 0; i < ids_.size(); ++i) occupy(position(i), first, n);
            std::size_t place = 0;
            for (std::uint32_t c = 0; c < n[2]; ++c) {
                for (std::uint32_t b = 0; b < n[1]; ++b) {
                    for (std::uint32_t a = 0; a < n[0]; ++a, ++place) {
                        if (taken_[place] != 0) continue;
                        if (ids_.size() >= options_.particles) return;
                        append(next_id_++, vec3{first[0] + s * a, first[1] + s * b, first[2] + s * c}, e.velocity);
                    }
                }
            }
        }
    }
    /// Marks the places closer than a spacing, less a hundredth for those that have just moved on.
    void occupy(vec3 const& p, vec3 const& first, std::array<std::uint32_t, 3> const& n) {
        double const s = options_.spacing;
        std::array<std::int64_t, 3> low{};
        std::array<std::int64_t, 3> high{};
        for (int d = 0; d < 3; ++d) {
            auto const e = static_cast<std::size_t>(d);
            double const at = (p[d] - first[d]) / s;
            if (!(at > -1 && at < n[e])) return;
            low[e] = std::max<std::int64_t>(static_cast<std::int64_t>(std::floor(at)), 0);
            high[e] = std::min<std::int64_t>(static_cast<std::int64_t>(std::floor(at)) + 1, n[e] - 1);
        }
        for (std::int64_t c = low[2]; c <= high[2]; ++c) {
            for (std::int64_t b = low[1]; b <= high[1]; ++b) {
                for (std::int64_t a = low[0]; a <= high[0]; ++a) {
                    vec3 const q{first[0] + s * static_cast<double>(a), first[1] + s * static_cast<double>(b), first[2] + s * static_cast<double>(c)};
                    if (squared_length(p - q) < 0.98 * s * s) {
                        taken_[static_cast<std::size_t>(a + n[0] * (b + n[1] * c))] = 1;
                    }
                }
            }
        }
    }

    template <executor E>
    void sort(E const& threads) {
        std::size_t const n = ids_.size();
        for (auto* t : {&sx_, &sv_, &sa_}) {
            for (auto& a : *t) a.resize(n + pad);
        }
        s_density_.resize(n + pad);
        s_pressure_.resize(n + pad);
        for (auto* t : {&sx_, &sv_}) {
            for (auto& a : *t) std::fill(a.end() - pad, a.end(), Scalar(0));
        }
        std::fill(s_density_.end() - pad, s_density_.end(), Scalar(0));
        std::fill(s_pressure_.end() - pad, s_pressure_.end(), Scalar(0));
        for (auto& a : a_) a.resize(n);
        spans_.resize(n);
        auto const order = grid_.order();
        threads.for_blocks(n, detail::particle_grain, [&](std::size_t from, std::size_t to) {
            for (std::size_t k = from; k < to; ++k) {
                std::size_t const i = order[k];
                for (std::size_t d = 0; d < 3; ++d) {
                    sx_[d][k] = x_[d][i];
                    sv_[d][k] = v_[d][i];
                }
                grid_.around(sx_[0][k], sx_[1][k], sx_[2][k], spans_[k]);
            }
        });
    }

    template <executor E>
    void sum(E const& threads) {
        std::size_t const n = ids_.size();
        bool const avx2 = detail::sph_has_avx2();
        detail::sph_arrays<Scalar> const all{
            .x = sx_[0].data(), .y = sx_[1].data(), .z = sx_[2].data(), .u = sv_[0].data(), .v = sv_[1].data(), .w = sv_[2].data(),
            .density = s_density_.data(), .pressure = s_pressure_.data(), .spans = spans_.data(),
            .ax = sa_[0].data(), .ay = sa_[1].data(), .az = sa_[2].data()};
        double const ratio = 1 / options_.smoothing;
        double const mass = ratio * ratio * ratio / pi;  // of a particle times the kernel's factor, over rho_0
        double const c = sound_ / h_;
        auto const order = grid_.order();
        threads.for_blocks(n, detail::particle_grain, [&](std::size_t from, std::size_t to) {
            detail::sph_densities(all, from, to, static_cast<Scalar>(mass), avx2);
            auto const stiff = static_cast<Scalar>(c * c);
            for (std::size_t k = from; k < to; ++k) {
                Scalar const rho = s_density_[k];
                s_pressure_[k] = rho > 1 ? stiff * (rho - 1) / (rho * rho) : Scalar(0);
            }
        });
        auto const viscous = static_cast<Scalar>(20 * viscosity_ / (h_ * h_));
        threads.for_blocks(n, detail::particle_grain, [&](std::size_t from, std::size_t to) {
            detail::sph_forces(all, from, to, static_cast<Scalar>(mass), viscous, avx2);
            for (std::size_t k = from; k < to; ++k) {
                std::size_t const i = order[k];
                density_[i] = s_density_[k];
                for (std::size_t d = 0; d < 3; ++d) a_[d][i] = sa_[d][k];
            }
        });
    }

    /// Gravity and walls.
    template <fluid_boundary B>
    [[nodiscard]] extremes add_forces(B const& walls, std::size_t from, std::size_t to) {
        extremes out;
        for (std::size_t k = from; k < to; ++k) {
            std::size_t const i = grid_.order()[k];
            vec3 const p = position(i);
            vec3 const v = velocity(i);
            vec3 a = options_.gravity;
            if (options_.toward != 0) {
                vec3 const in{options_.centre - p};
                double const far = length(in);
                if (far > 0) a += options_.toward / far * in;
            }
            walls.for_each_contact(p, reach_, [&](boundary_contact const& c) {
                double const f = stiffness_ * (reach_ - c.distance) - damping_ * dot(v, c.normal);
                a += f * c.normal;
            });
            double fast = 0;
            double pushed = 0;
            for (std::size_t d = 0; d < 3; ++d) {
                a_[d][i] += static_cast<Scalar>(a[static_cast<int>(d)] / h_);
                auto const w = static_cast<double>(v_[d][i]);
                auto const b = static_cast<double>(a_[d][i]);
                fast += w * w;
                pushed += b * b;
            }
            out.velocity = std::max(out.velocity, fast);
            out.acceleration = std::max(out.acceleration, pushed);
            out.finite = out.finite && std::isfinite(fast) && std::isfinite(pushed);
        }
        return out;
    }

    /// All in units of h and seconds.
    [[nodiscard]] double time_step(extremes const& e) const {
        double least = 1 / (sound_ / h_ + std::sqrt(e.velocity));
        least = std::min(least, std::sqrt(1 / std::sqrt(e.acceleration)));
        least = std::min(least, h_ * h_ / (4 * viscosity_));
        least = std::min({least, 1 / std::sqrt(stiffness_), 1 / damping_});
        double const dt = std::min(options_.courant * least, options_.largest_step);
        if (!e.finite || !(dt > 0)) {
            detail::fail<invalid_input>(errc::out_of_range, "sph: velocities or accelerations are beyond the numbers of the scalar",
                                        {.value = e.acceleration});
        }
        return dt;
    }

    /// Takes away what has left, in place: ids stay in order.
    void drain() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            if (!sink_.keep.contains(position(i))) continue;
            if (kept != i) {
                ids_[kept] = ids_[i];
                density_[kept] = density_[i];
                for (std::size_t d = 0; d < 3; ++d) {
                    x_[d][kept] = x_[d][i];
                    v_[d][kept] = v_[d][i];
                }
            }
            ++kept;
        }
        ids_.resize(kept);
        resize(kept);
    }

    sph_options options_;
    box_sink sink_;
    std::vector<box_emitter> emitters_;
    vec3 origin_{0, 0, 0};
    double h_ = 1;
    double sound_ = 1;
    double reach_ = 1;
    double stiffness_ = 1;
    double damping_ = 1;
    double viscosity_ = 0;
    std::uint64_t next_id_ = 0;
    std::vector<std::uint64_t> ids_{};  ///< ascending; all arrays without `s` go with it
    triple x_{};                        ///< from the origin, in h
    triple v_{};                        ///< h / s
    triple a_{};                        ///< h / s^2
    std::vector<Scalar> density_{};
    std::vector<unsigned char> taken_{};
    detail::particle_grid<Scalar> grid_{};
    triple sx_{};                       ///< sorted by cell
    triple sv_{};
    triple sa_{};
    std::vector<Scalar> s_density_{};
    std::vector<Scalar> s_pressure_{};
    std::vector<detail::sph_spans> spans_{};
};

static_assert(particle_fluid<sph<float>> && particle_fluid<sph<double>>);

}  // namespace tafoni

#endif
