/// \file
/// Smoothed particle hydrodynamics: a weakly compressible fluid of particles.
#ifndef TAFONI_FLUID_SPH_HPP
#define TAFONI_FLUID_SPH_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/concepts.hpp>
#include <tafoni/fluid/detail/fluid_bytes.hpp>
#include <tafoni/fluid/detail/free_places.hpp>
#include <tafoni/fluid/detail/particle_grid.hpp>
#include <tafoni/fluid/detail/sorted_fluid.hpp>
#include <tafoni/fluid/emitter.hpp>
#include <tafoni/fluid/facing_contacts.hpp>
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
/// d = reach - distance [thesis, equation 8.1 with the erratum], and by -friction v; velocities first, then positions. The
/// step is courant times the least of h / (c + v), sqrt(h / a) / 2, h^2 / (12 nu), 1 / sqrt(k_s), 1 / k_d and
/// 1 / friction, at most `largest_step`.
/// An emitter puts a particle on each place of its lattice that is free as long as there may be more, on places spread
/// evenly over its box where not all can have one; the sink takes away what leaves its box. The sums over neighbours run by cell and id in fixed lanes: the state depends on
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
            places_.emplace_back(e, options_.spacing);
        }
        h_ = options_.smoothing * options_.spacing;
        if (!emitters_.empty()) origin_ = emitters_[0].box.lo;
        for (box_emitter const& e : emitters_) {
            if (holds(e.box.lo, e.velocity) && holds(e.box.hi, e.velocity)) continue;
            detail::fail<invalid_input>(errc::out_of_range, "sph: an emitter is too far from the first, or too fast, for numbers of the scalar");
        }
        sound_ = options_.sound_speed > 0 ? options_.sound_speed : 10 * fastest();
        detail::require_range("sph_options.sound_speed (without gravity or speed from an emitter it must be given)", sound_, 1e-100, 1e100);
        reach_ = options_.reach > 0 ? options_.reach : options_.spacing;
        double const pace = sound_ / (5 * reach_);
        stiffness_ = options_.wall_stiffness > 0 ? options_.wall_stiffness : pace * pace;
        damping_ = options_.wall_damping > 0 ? options_.wall_damping : pace;
        viscosity_ = options_.viscosity + options_.damping * h_ * sound_ / 10;
    }
    sph(box_emitter const& emitter, box_sink const& sink, sph_options const& options = {})
        : sph(std::vector<box_emitter>{emitter}, sink, options) {}

    /// Replaces all particles. O(n log n). \throws invalid_input  `non_finite_vertex` with the place in `all`, also for
    /// what the scalar cannot hold; `bad_parameter` for an id that is given twice or 2^63 and more; `size_overflow` for more than `options.particles`.
    void place(std::span<fluid_particle const> all) {
        if (all.size() > options_.particles) {
            detail::fail<invalid_input>(errc::size_overflow, "sph.place: more particles than sph_options.particles",
                                        {.value = static_cast<double>(all.size()), .limit = static_cast<double>(options_.particles)});
        }
        std::vector<fluid_particle> sorted(all.begin(), all.end());
        std::sort(sorted.begin(), sorted.end(), [](auto const& a, auto const& b) { return a.id < b.id; });
        for (std::size_t i = 0; i < sorted.size(); ++i) {
            bool const twice = i > 0 && sorted[i].id == sorted[i - 1].id;
            if (!twice && sorted[i].id >> 63 == 0) continue;
            detail::fail<invalid_input>(errc::bad_parameter, "sph.place: id " + std::to_string(sorted[i].id) + (twice ? " is given twice" : " is 2^63 or more"),
                                        {.kind = entity::parameter, .value = static_cast<double>(sorted[i].id)});
        }
        vec3 const then = origin_;
        if (emitters_.empty() && !sorted.empty()) origin_ = sorted[0].position;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (holds(all[i].position, all[i].velocity)) continue;
            origin_ = then;
            detail::fail<invalid_input>(errc::non_finite_vertex, "sph.place: particle " + std::to_string(i) + " is not finite",
                                        {.kind = entity::vertex, .index = i});
        }
        try {
            make_room(sorted.size());
        } catch (...) {
            origin_ = then;
            throw;
        }
        resize(0);
        ids_.clear();
        for (fluid_particle const& p : sorted) append(p.id, p.position, p.velocity);
        next_id_ = sorted.empty() ? 0 : sorted.back().id + 1;
        made_ = 0;
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
    [[nodiscard]] double reach() const noexcept { return reach_; }          ///< length unit
    [[nodiscard]] double sound_speed() const noexcept { return sound_; }    ///< c, length unit / s
    [[nodiscard]] sph_options const& options() const noexcept { return options_; }

    /// One step, or as many as make a frame. O(steps x (particles x neighbours + cells)).
    /// \throws invalid_input  `size_overflow` where particles pile up on a point, `out_of_range` where an acceleration is
    /// no number or a frame would take a million steps; no particle has moved in that step then, and the next call
    /// goes on with the frame.
    template <fluid_boundary B, executor E>
    double step(B const& walls, E const& threads) {
        if (options_.frame == 0) return advance(walls, threads, options_.largest_step);
        while (made_ < options_.frame) {
            double const rest = options_.frame - made_;
            double const dt = advance(walls, threads, rest);
            made_ = dt < rest ? made_ + dt : options_.frame;
        }
        made_ = 0;
        return options_.frame;
    }

    /// All that decides the steps to come, and what the fluid was told. O(particles).
    void save(detail::byte_writer& bytes) const {
        detail::fluid_writer out(bytes, kind, settings());
        out.put(origin_);
        out.put(next_id_);
        out.put(made_);
        out.put(std::uint64_t{ids_.size()});
        for (std::size_t i = 0; i < ids_.size(); ++i) {
            out.put(ids_[i]);
            for (triple const* t : {&x_, &v_}) {
                for (auto const& a : *t) out.put(a[i]);
            }
            out.put(density_[i]);
        }
        out.finish();
    }
    /// Goes on where `save` was called; the next steps are equal to the bit. O(particles).
    /// \throws invalid_input  `checkpoint_mismatch` for other options, emitters or sink; io_error  `wrong_format` for
    /// another fluid or scalar, `truncated`, `bad_syntax`. The fluid is as before then.
    void load(detail::byte_reader& bytes) {
        detail::fluid_reader in(bytes, kind);
        sph next(*this);
        in.get(next.origin_);
        next.next_id_ = in.get();
        in.get(next.made_);
        if (!(next.made_ >= 0 && next.made_ <= options_.frame)) in.bad("the time is out of range");
        std::size_t const n = in.count(8 + 7 * sizeof(Scalar));
        next.ids_.resize(n);
        next.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            next.ids_[i] = in.get();
            if ((i > 0 && next.ids_[i] <= next.ids_[i - 1]) || next.ids_[i] >= next.next_id_) in.bad("ids do not ascend");
            for (triple* t : {&next.x_, &next.v_}) {
                for (auto& a : *t) in.get(a[i]);
            }
            in.get(next.density_[i]);
        }
        in.finish(settings());
        if (n > options_.particles) in.bad("there are more particles than the options allow");
        *this = std::move(next);
    }

private:
    static constexpr std::uint64_t kind = 0x7461662D73706800ULL + sizeof(Scalar);  // "taf-sph"
    static constexpr double pi = 3.14159265358979323846;
    using triple = detail::fluid_axes<Scalar>;

    struct extremes {
        double velocity = 0;      ///< largest square, h^2 / s^2
        double acceleration = 0;  ///< largest square, h^2 / s^4
        bool finite = true;
    };

    [[nodiscard]] detail::fluid_settings settings() const {
        detail::fluid_settings out;
        options_.describe(out);
        out.add(sink_);
        for (box_emitter const& e : emitters_) out.add(e);
        return out;
    }

    /// Of the fall through a pool, or out of an emitter.
    [[nodiscard]] double fastest() const noexcept {
        double const g = std::max(length(options_.gravity), std::fabs(options_.toward));
        double square = 2 * g * 16 * options_.spacing;
        for (box_emitter const& e : emitters_) square = std::max(square, squared_length(e.velocity));
        return std::sqrt(square);
    }

    /// Whether the scalar can hold a place from the origin, and a velocity, with room for their squares' sums.
    [[nodiscard]] bool holds(vec3 const& p, vec3 const& v) const noexcept {
        constexpr double most = sizeof(Scalar) == 4 ? 1e18 : 1e150;
        for (int d = 0; d < 3; ++d) {
            if (!(std::fabs((p[d] - origin_[d]) / h_) <= most && std::fabs(v[d] / h_) <= most)) return false;
        }
        return true;
    }

    void resize(std::size_t n) {
        for (triple* t : {&x_, &v_}) {
            for (auto& a : *t) a.resize(n);
        }
        density_.resize(n, Scalar(0));
    }
    /// So that `append` does not throw half way.
    void make_room(std::size_t n) {
        auto const reserve = [&](auto& a) {
            if (a.capacity() < n) a.reserve(std::max(n, 2 * a.capacity()));
        };
        reserve(ids_);
        for (triple* t : {&x_, &v_}) {
            for (auto& a : *t) reserve(a);
        }
        reserve(density_);
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

    void emit() {
        for (std::size_t k = 0; k < emitters_.size(); ++k) {
            if (ids_.size() >= options_.particles) return;
            detail::free_places& places = places_[k];
            places.clear();
            for (std::size_t i = 0; i < ids_.size(); ++i) places.occupy(position(i));
            places.take(options_.particles - ids_.size(), next_id_, [&](vec3 const& p) {
                make_room(ids_.size() + 1);
                append(next_id_++, p, emitters_[k].velocity);
            });
        }
    }

    /// One stable step, in a frame an even share of the rest `most` of it.
    template <fluid_boundary B, executor E>
    double advance(B const& walls, E const& threads, double most) {
        emit();
        std::size_t const n = ids_.size();
        if (n == 0) return most;
        double const ratio = 1 / options_.smoothing;
        double const pace = sound_ / h_;
        neighbours_.accelerate(x_, v_, {.mass = ratio * ratio * ratio / pi, .stiffness = pace * pace, .viscosity = 20 * viscosity_ / (h_ * h_)},
                               a_, density_, threads);
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
        double const dt = time_step(all, most);
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

    /// Gravity and walls.
    template <fluid_boundary B>
    [[nodiscard]] extremes add_forces(B const& walls, std::size_t from, std::size_t to) {
        extremes out;
        for (std::size_t k = from; k < to; ++k) {
            std::size_t const i = neighbours_.order()[k];
            vec3 const p = position(i);
            vec3 const v = velocity(i);
            vec3 a = options_.gravity;
            if (options_.toward != 0) {
                vec3 const in{options_.centre - p};
                double const far = length(in);
                if (far > 0) a += options_.toward / far * in;
            }
            bool touches = false;
            for_each_facing_contact(walls, p, reach_, [&](boundary_contact const& c) {
                double const f = stiffness_ * (reach_ - c.distance) - damping_ * dot(v, c.normal);
                a += f * c.normal;
                touches = true;
            });
            if (touches && options_.friction > 0) a -= options_.friction * v;
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
    [[nodiscard]] double time_step(extremes const& e, double most) const {
        double least = 1 / (sound_ / h_ + std::sqrt(e.velocity));
        least = std::min(least, 0.5 * std::sqrt(1 / std::sqrt(e.acceleration)));
        least = std::min(least, h_ * h_ / (12 * viscosity_));
        least = std::min({least, 1 / std::sqrt(stiffness_), 1 / damping_});
        if (options_.friction > 0) least = std::min(least, 1 / options_.friction);
        double const dt = std::min(options_.courant * least, options_.largest_step);
        if (!e.finite || !(dt > 0)) {
            detail::fail<invalid_input>(errc::out_of_range, "sph: velocities or accelerations are beyond the numbers of the scalar",
                                        {.value = e.acceleration});
        }
        if (options_.frame == 0) return dt;
        double const shares = std::ceil(most / dt);
        if (!(shares <= 1e6)) {
            detail::fail<invalid_input>(errc::out_of_range, "sph: a frame of " + detail::number_text(options_.frame) + " s takes more than 10^6 steps",
                                        {.kind = entity::parameter, .value = shares, .limit = 1e6});
        }
        return most / std::max(shares, 1.0);
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
    double made_ = 0;                   ///< of a frame that an exception cut short, s
    std::uint64_t next_id_ = 0;
    std::vector<std::uint64_t> ids_{};  ///< ascending; all arrays without `s` go with it
    triple x_{};                        ///< from the origin, in h
    triple v_{};                        ///< h / s
    triple a_{};                        ///< h / s^2
    std::vector<Scalar> density_{};
    std::vector<detail::free_places> places_{};  ///< of each emitter
    detail::sorted_fluid<Scalar> neighbours_{};
};

static_assert(particle_fluid<sph<float>> && particle_fluid<sph<double>>);

}  // namespace tafoni

#endif
