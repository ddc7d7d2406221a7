/// \file
/// Drops that fall, land and run off: the cheap fluid.
#ifndef TAFONI_FLUID_RAIN_PARTICLES_HPP
#define TAFONI_FLUID_RAIN_PARTICLES_HPP

#include <tafoni/core/executor.hpp>
#include <tafoni/core/random.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/concepts.hpp>
#include <tafoni/fluid/detail/fluid_bytes.hpp>
#include <tafoni/fluid/detail/visit_order.hpp>
#include <tafoni/fluid/emitter.hpp>
#include <tafoni/fluid/facing_contacts.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace tafoni {

/// What rain is told; lengths in the model's unit.
struct rain_options {
    std::uint32_t particles = 10000;   ///< drops under way, 1 .. 2^24
    double radius = 1;                 ///< at which a drop touches the ground, length unit, > 0
    vec3 gravity{0, 0, -9.81};         ///< length unit / s^2
    double friction = 1;               ///< share of the velocity along the ground that is lost per second, 1/s, >= 0
    double adhesion = 0.8;             ///< pull of the ground on a drop that touches it, over that of gravity, in [0, 10]:
                                       ///< a slow drop hangs on where it overhangs by less than asin(adhesion)
    double largest_step = 0.05;        ///< s, > 0
    double frame = 0;                  ///< s that `step` advances by, each drop in as many steps as it takes; 0 = one step
                                       ///< for all, as the fastest needs it
    double lifetime = 30;              ///< s after which a drop has seeped away, > 0
    std::uint64_t seed = 0;

    /// Calls `out.add` with each number in turn: what saved rain is compared by.
    void describe(auto& out) const {
        out.add(std::uint64_t{particles});
        out.add(radius);
        out.add(gravity);
        for (double const v : {friction, adhesion, largest_step, frame, lifetime}) out.add(v);
        out.add(seed);
    }

    /// \throws invalid_input  `bad_parameter`.
    void validate() const {
        detail::require_range("rain_options.particles", particles, 1, 1u << 24);
        detail::require_range("rain_options.radius", radius, std::numeric_limits<double>::min(), 1e100);
        for (int d = 0; d < 3; ++d) detail::require_range("rain_options.gravity", gravity[d], -1e100, 1e100);
        detail::require_range("rain_options.friction", friction, 0, 1e6);
        detail::require_range("rain_options.adhesion", adhesion, 0, 10);
        detail::require_range("rain_options.largest_step", largest_step, 1e-12, 1e12);
        detail::require_range("rain_options.frame", frame, 0, 1e12);
        detail::require_range("rain_options.lifetime", lifetime, 1e-12, 1e12);
    }
};

/// Drops without pressure: ballistic in the air, along the surface once they touch it, slowed by friction.
///
/// The ground pulls a drop within `radius` by adhesion x |g|, and no closer than half the radius, where it rests; so it
/// runs round a form as long as n . g + v^2 / R < adhesion |g|, with n out of the ground and R the form's radius, and
/// drips off or shoots over the edge from there on.
///
/// A drop that leaves the sink's box or outlives its time starts again in the emitter under a new id. Draws depend on
/// (seed, id) only. Models `particle_fluid`.
class rain_particles {
public:
    /// All drops start at once, spread over the emitter. O(particles).
    /// \throws invalid_input  `bad_parameter`, `bad_box`.
    rain_particles(box_emitter const& emitter, box_sink const& sink, rain_options const& options = {})
        : emitter_((emitter.validate(), emitter)), sink_((sink.validate(), sink)), options_((options.validate(), options)) {
        pull_ = options_.adhesion * length(options_.gravity);
        drops_.resize(options_.particles);
        for (std::size_t i = 0; i < drops_.size(); ++i) drops_[i] = fresh(i);
        next_id_ = drops_.size();
    }

    /// Always as many as the options say; by number i, which a drop keeps until another takes its place under a new id.
    [[nodiscard]] std::size_t particle_count() const noexcept { return drops_.size(); }
    [[nodiscard]] vec3 position(std::size_t i) const noexcept { return drops_[i].position; }
    [[nodiscard]] vec3 velocity(std::size_t i) const noexcept { return drops_[i].velocity; }
    [[nodiscard]] std::uint64_t id(std::size_t i) const noexcept { return drops_[i].id; }
    [[nodiscard]] double reach() const noexcept { return options_.radius; }
    [[nodiscard]] rain_options const& options() const noexcept { return options_; }

    /// One step, in which no drop falls or runs farther than half its radius and none comes nearer to the ground by more
    /// than that, at most `largest_step` long; or a frame of such steps. O(particles x steps x faces near one).
    /// \throws invalid_input  `out_of_range` where a drop would take a million steps in a frame. The rain is as before
    /// then, and where the walls throw.
    template <fluid_boundary B, executor E>
    double step(B const& walls, E const& threads) {
        double const dt = options_.frame > 0 ? options_.frame : stable(fastest());
        order_.sort(walls, drops_.size(), [&](std::size_t i) -> vec3 const& { return drops_[i].position; }, threads);
        next_.resize(drops_.size());
        threads.for_blocks(drops_.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                order_.look_ahead(walls, k);
                drop& d = next_[order_[k]];
                d = drops_[order_[k]];
                if (options_.frame > 0) {
                    move_for(d, walls, dt);
                } else {
                    move(d, walls, dt);
                }
            }
        });
        drops_.swap(next_);
        for (drop& d : drops_) {
            if (gone(d)) d = fresh(next_id_++);
        }
        return dt;
    }

    /// All that decides the steps to come, and what the rain was told. O(particles).
    void save(detail::byte_writer& bytes) const {
        detail::fluid_writer out(bytes, kind, settings());
        out.put(next_id_);
        out.put(std::uint64_t{drops_.size()});
        for (drop const& d : drops_) {
            out.put(d.id);
            out.put(d.position);
            out.put(d.velocity);
            out.put(d.age);
        }
        out.finish();
    }
    /// Goes on where `save` was called; the next steps are equal to the bit. O(particles).
    /// \throws invalid_input  `checkpoint_mismatch` for other options, another emitter or sink; io_error  `wrong_format`
    /// for another fluid, `truncated`, `bad_syntax`. The rain is as before then.
    void load(detail::byte_reader& bytes) {
        detail::fluid_reader in(bytes, kind);
        std::uint64_t const next = in.get();
        std::vector<drop> drops(in.count(64));
        for (drop& d : drops) {
            d.id = in.get();
            in.get(d.position);
            in.get(d.velocity);
            in.get(d.age);
        }
        in.finish(settings());
        if (drops.size() != options_.particles) in.bad("the number of drops is not that of the options");
        std::vector<std::uint64_t> ids;
        for (drop const& d : drops) ids.push_back(d.id);
        std::sort(ids.begin(), ids.end());
        if (std::adjacent_find(ids.begin(), ids.end()) != ids.end() || ids.back() >= next) in.bad("ids repeat");
        drops_ = std::move(drops);
        next_id_ = next;
    }

private:
    static constexpr std::uint64_t kind = 0x7461662D7261696EULL;  // "taf-rain"

    struct drop {
        vec3 position{0, 0, 0};
        vec3 velocity{0, 0, 0};
        double age = 0;
        std::uint64_t id = 0;
    };

    [[nodiscard]] detail::fluid_settings settings() const {
        detail::fluid_settings out;
        options_.describe(out);
        out.add(sink_);
        out.add(emitter_);
        return out;
    }

    [[nodiscard]] drop fresh(std::uint64_t id) const {
        stream random(options_.seed, 0x7261696E, id);
        drop d{.position = vec3{0, 0, 0}, .velocity = emitter_.velocity, .age = 0, .id = id};
        for (int a = 0; a < 3; ++a) d.position[a] = random.uniform(emitter_.box.lo[a], emitter_.box.hi[a]);
        return d;
    }

    [[nodiscard]] bool gone(drop const& d) const noexcept { return d.age >= options_.lifetime || !sink_.keep.contains(d.position); }

    [[nodiscard]] double fastest() const noexcept {
        double square = 0;
        for (drop const& d : drops_) square = std::max(square, squared_length(d.velocity));
        return std::sqrt(square);
    }
    /// The step in which a drop of speed `v` moves by half the radius: that = v dt + g dt^2. What the ground pulls stops at
    /// half the radius from it.
    [[nodiscard]] double stable(double v) const noexcept {
        double const g = length(options_.gravity);
        double const far = 0.5 * options_.radius;
        double const dt = v + g > 0 ? 2 * far / (v + std::sqrt(v * v + 4 * g * far)) : options_.largest_step;
        return std::min(dt, options_.largest_step);
    }

    /// In even shares of what is left; not beyond the end of the drop.
    template <fluid_boundary B>
    void move_for(drop& d, B const& walls, double rest) const {
        while (rest > 0 && !gone(d)) {
            double const shares = std::ceil(rest / stable(length(d.velocity)));
            if (!(shares <= 1e6)) {
                detail::fail<invalid_input>(errc::out_of_range,
                                            "rain_particles: a drop takes more than 10^6 steps in a frame of " + detail::number_text(options_.frame) + " s",
                                            {.kind = entity::parameter, .value = shares, .limit = 1e6});
            }
            double const dt = rest / std::max(shares, 1.0);
            move(d, walls, dt);
            rest = shares > 1 ? rest - dt : 0;
        }
    }

    template <fluid_boundary B>
    void move(drop& d, B const& walls, double dt) const {
        for (int a = 0; a < 3; ++a) d.velocity[a] += options_.gravity[a] * dt;
        double const rest = 0.5 * options_.radius;
        boundary_contact nearest;
        double near = std::numeric_limits<double>::infinity();
        vec3 push{0, 0, 0};
        for_each_facing_contact(walls, d.position, options_.radius, [&](boundary_contact const& c) {
            double const deep = rest - c.distance;
            add(d.velocity, std::max(std::min(deep, 0.0) / dt - dot(d.velocity, c.normal), 0.0), c.normal);
            if (deep > 0) add(push, deep, c.normal);
            if (std::fabs(c.distance) < near) {
                near = std::fabs(c.distance);
                nearest = c;
            }
        });
        if (std::isfinite(near)) {
            double const leaves = dot(d.velocity, nearest.normal) - std::min(rest - nearest.distance, 0.0) / dt;
            add(d.velocity, -std::max(std::min(pull_ * dt, leaves), 0.0), nearest.normal);
            double const slower = 1 / (1 + options_.friction * dt);
            for (int a = 0; a < 3; ++a) d.velocity[a] *= slower;
        }
        double const far = length(push);
        double const share = far > rest ? rest / far : 1.0;
        for (int a = 0; a < 3; ++a) d.position[a] += d.velocity[a] * dt + share * push[a];
        d.age += dt;
    }
    static void add(vec3& to, double share, vec3 const& way) noexcept {
        to = vec3{to[0] + share * way[0], to[1] + share * way[1], to[2] + share * way[2]};
    }

    box_emitter emitter_;
    box_sink sink_;
    rain_options options_;
    double pull_ = 0;  ///< of the ground, length unit / s^2
    std::vector<drop> drops_{};
    std::vector<drop> next_{};
    detail::visit_order order_{};
    std::uint64_t next_id_ = 0;
};

static_assert(particle_fluid<rain_particles>);

}  // namespace tafoni

#endif
