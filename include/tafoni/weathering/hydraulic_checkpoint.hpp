/// \file
/// The bytes that a hydraulic run is saved as and goes on from.
#ifndef TAFONI_WEATHERING_HYDRAULIC_CHECKPOINT_HPP
#define TAFONI_WEATHERING_HYDRAULIC_CHECKPOINT_HPP

#include <tafoni/fluid/concepts.hpp>
#include <tafoni/geometry/refined_origins.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/weathering/detail/checkpoint_bytes.hpp>
#include <tafoni/weathering/detail/sediment.hpp>
#include <tafoni/weathering/detail/surface_hash.hpp>
#include <tafoni/weathering/hydraulic_erosion.hpp>

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni {

/// A particle fluid that a checkpoint can hold; `hydraulic_run` of any other has no `checkpoint` and no `resume`.
///
/// Laws: `save(out)` writes all that decides the next steps, and the parameters; `load(in)` reads as much as was written
/// and makes the fluid equal to the one that was saved, or throws (for other parameters `invalid_input`) and leaves it as
/// it was. Model: `void save(auto& out) const { out.put(std::uint64_t{n}); out.put_real(x); }
///                 void load(auto& in) { n = in.get(); x = in.get_real(); }`
template <class F>
concept saved_fluid = particle_fluid<F> && std::copyable<F> &&
                      requires(F& f, F const& c, detail::byte_writer& out, detail::byte_reader& in) {
                          { c.save(out) } -> std::same_as<void>;
                          { f.load(in) } -> std::same_as<void>;
                      };

namespace detail {

/// What a hydraulic run is between two iterations, beside the fluid. The ledger of the report is that of the books.
struct hydraulic_state {
    triangle_surface surface{};
    std::vector<double> wear{};
    std::vector<std::uint64_t> flow{};
    std::vector<std::int64_t> sediment{};
    sediment_books books{};
    hydraulic_report report{};
    double ahead = 0;  ///< s that the fluid is ahead of the surface by
    std::vector<double> clear{};  ///< way that vertices have to other walls, below 0 unknown; or empty
    std::vector<double> given{};  ///< that they had when it was found; as many
    refined_origins origins{};
};

/// Options and process; fields as they answer at the vertices of the input. O(vertices).
template <class Process>
[[nodiscard]] std::uint64_t parameter_hash(Process const& process, hydraulic_options const& o, std::span<vec3 const> input) {
    number_hash h;
    h.add(o.step_divisor);
    h.add(o.refine_length);
    h.add(std::uint64_t{o.refine_every});
    h.add(std::uint64_t{o.check_every});
    auto const add_field = [&](auto const& field) {
        for (vec3 const& p : input) h.add(static_cast<double>(field(p)));
    };
    if constexpr (is_curvature_erosion<Process>) {
        add_policy(h, process.estimator);
        h.add(process.power);
        h.add(process.influence);
        add_field(process.durability);
    } else if constexpr (std::same_as<Process, partheniades_erosion>) {
        for (any_field const* f : {&process.coefficient, &process.critical, &process.exponent, &process.consistency, &process.power}) {
            add_field(*f);
        }
    } else {
        add_policy(h, process);
    }
    return h.value();
}

inline constexpr std::uint64_t hydraulic_checkpoint_magic = 0x6479682D66617400ULL;  // "\0taf-hyd"
inline constexpr std::uint64_t hydraulic_checkpoint_version = 3;

/// Magic, version, hashes of the input and of the parameters, state, fluid, hash. O(vertices + faces + particles).
template <class Fluid>
[[nodiscard]] std::vector<std::byte> write_checkpoint(hydraulic_state const& s, Fluid const& fluid, std::uint64_t input,
                                                      std::uint64_t parameters) {
    byte_writer out;
    out.reserve(512 + 64 * s.surface.positions.size() + 12 * s.surface.triangles.size() + 80 * fluid.particle_count());
    out.put(hydraulic_checkpoint_magic);
    out.put(hydraulic_checkpoint_version, 4);
    out.put(input);
    out.put(parameters);
    out.put(std::uint64_t{s.surface.positions.size()});
    out.put(std::uint64_t{s.surface.triangles.size()});
    for (vec3 const& p : s.surface.positions) {
        for (int d = 0; d < 3; ++d) out.put_real(p[d]);
    }
    for (auto const& t : s.surface.triangles) {
        for (std::uint32_t const c : t) out.put(std::uint64_t{c}, 4);
    }
    auto const put_units = [&](std::int64_t v) { out.put(static_cast<std::uint64_t>(v)); };
    for (double const w : s.wear) out.put_real(w);
    for (std::uint64_t const f : s.flow) out.put(f);
    for (std::int64_t const v : s.sediment) put_units(v);
    for (std::int64_t const v : s.books.due) put_units(v);
    for (volume_sum const v : {s.books.eroded, s.books.deposited, s.books.left}) {
        out.put(static_cast<std::uint64_t>(v));
        out.put(static_cast<std::uint64_t>(v >> 64));
    }
    std::uint64_t loaded = 0;
    for (auto const& e : s.books.load.all()) loaded += e.units != 0 ? 1U : 0U;
    out.put(loaded);
    for (auto const& e : s.books.load.all()) {
        if (e.units == 0) continue;
        out.put(e.id);
        put_units(e.units);
    }
    out.put(s.report.iterations);
    out.put_real(s.report.time);
    out.put(s.report.contacts);
    out.put(std::uint64_t{s.report.vertices_added});
    out.put_real(s.ahead);
    out.put(std::uint64_t{s.clear.size()});
    for (double const c : s.clear) out.put_real(c);
    for (double const c : s.given) out.put_real(c);
    for (auto const& m : s.origins.midpoints) {
        for (std::uint32_t const v : m) out.put(std::uint64_t{v}, 4);
    }
    for (face_index const f : s.origins.face) out.put(std::uint64_t{f.value}, 4);
    fluid.save(out);
    out.put(byte_hash(out.bytes()));
    return std::move(out.bytes());
}

/// Checks everything that is read. `inputs` and `faces` are the numbers of vertices and faces that the run began with.
class hydraulic_checkpoint_reader {
public:
    hydraulic_checkpoint_reader(std::span<std::byte const> bytes, std::size_t inputs, std::size_t faces)
        : bytes_(bytes), in_(bytes, who), inputs_(inputs), input_faces_(faces) {}

    /// Also loads `fluid`, which is lost where this throws.
    /// \throws io_error  `wrong_format`, `unsupported`, `checkpoint_mismatch`, `truncated`, `bad_syntax`. O(bytes).
    template <class Fluid>
    [[nodiscard]] hydraulic_state read(Fluid& fluid, std::uint64_t input, std::uint64_t parameters) {
        if (bytes_.size() < 8 || in_.get() != hydraulic_checkpoint_magic) {
            fail<io_error>(errc::wrong_format, std::string(who) + ": these bytes are no hydraulic checkpoint");
        }
        if (std::uint64_t const version = in_.get(4); version != hydraulic_checkpoint_version) {
            fail<io_error>(errc::unsupported, std::string(who) + ": checkpoint version " + std::to_string(version) +
                                                  ", this library reads " + std::to_string(hydraulic_checkpoint_version));
        }
        if (in_.get() != input) fail<io_error>(errc::checkpoint_mismatch, std::string(who) + ": the checkpoint belongs to another mesh");
        if (in_.get() != parameters) {
            fail<io_error>(errc::checkpoint_mismatch, std::string(who) + ": the checkpoint was made with other parameters");
        }
        byte_reader end(bytes_.last(8), who);
        if (end.get() != byte_hash(bytes_.first(bytes_.size() - 8))) bad("the checksum is wrong");
        hydraulic_state s = state();
        fluid.load(in_);
        if (in_.left() != 8) bad("bytes follow the end");
        return s;
    }

private:
    static constexpr char const* who = "hydraulic_run::resume";

    [[noreturn]] static void bad(char const* why) { fail<io_error>(errc::bad_syntax, std::string(who) + ": " + why); }

    [[nodiscard]] std::int64_t units() { return static_cast<std::int64_t>(in_.get()); }
    /// What a vertex or a particle may hold.
    [[nodiscard]] std::int64_t held() {
        std::int64_t const v = units();
        if (v > std::int64_t{1} << 61 || v < -(std::int64_t{1} << 61)) bad("a volume is out of range");
        return v;
    }
    [[nodiscard]] double positive() {
        double const d = in_.get_real();
        if (d < 0) bad("a length or a time is negative");
        return d;
    }

    [[nodiscard]] hydraulic_state state() {
        hydraulic_state s;
        std::uint64_t const n = in_.get();
        std::uint64_t const faces = in_.get();
        if (n < inputs_ || n > in_.left() / 56 || faces > in_.left() / 12) bad("the counts do not fit the mesh");
        s.surface.positions.resize(static_cast<std::size_t>(n));
        for (vec3& p : s.surface.positions) {
            for (int d = 0; d < 3; ++d) p[d] = in_.get_real();
        }
        s.surface.triangles.resize(static_cast<std::size_t>(faces));
        for (auto& t : s.surface.triangles) {
            for (std::uint32_t& c : t) {
                c = static_cast<std::uint32_t>(in_.get(4));
                if (c >= n) bad("a vertex is out of range");
            }
        }
        s.wear.resize(s.surface.positions.size());
        for (double& w : s.wear) w = positive();
        s.flow.resize(s.surface.positions.size());
        for (std::uint64_t& f : s.flow) f = in_.get();
        s.sediment.resize(s.surface.positions.size());
        for (std::int64_t& v : s.sediment) v = units();
        s.books.due.resize(s.surface.positions.size());
        for (std::int64_t& v : s.books.due) v = held();
        for (volume_sum* v : {&s.books.eroded, &s.books.deposited, &s.books.left}) {
            volume_sum const low = in_.get();
            *v = low + (volume_sum{units()} * (volume_sum{1} << 64));
        }
        std::uint64_t const loaded = in_.get();
        if (loaded > in_.left() / 16) bad("there are fewer bytes than loads");
        for (std::uint64_t k = 0; k < loaded; ++k) {
            std::uint64_t const id = in_.get();
            s.books.load.all().push_back({id, held()});
        }
        if (!s.books.balanced()) bad("the ledger does not balance");
        s.report.iterations = in_.get();
        s.report.time = positive();
        s.report.contacts = in_.get();
        s.report.vertices_added = static_cast<std::size_t>(in_.get());
        s.ahead = positive();
        std::uint64_t const clear = in_.get();
        if ((clear != 0 && clear != n) || clear > in_.left() / 16) bad("the count of ways does not fit the mesh");
        s.clear.resize(static_cast<std::size_t>(clear));
        for (double& c : s.clear) c = in_.get_real();
        s.given.resize(s.clear.size());
        for (double& c : s.given) c = in_.get_real();
        s.origins.midpoints.resize(s.surface.positions.size() - inputs_);
        for (std::size_t k = 0; k < s.origins.midpoints.size(); ++k) {
            auto& [a, b] = s.origins.midpoints[k];
            a = static_cast<std::uint32_t>(in_.get(4));
            b = static_cast<std::uint32_t>(in_.get(4));
            if (!(a < b && b < inputs_ + k)) bad("a vertex comes from one that is not before it");
        }
        s.origins.face.resize(s.surface.triangles.size());
        for (face_index& f : s.origins.face) {
            f = face_index{static_cast<std::uint32_t>(in_.get(4))};
            if (f.value >= input_faces_) bad("a face comes from none");
        }
        return s;
    }

    std::span<std::byte const> bytes_;
    byte_reader in_;
    std::size_t inputs_;
    std::size_t input_faces_;
};

}  // namespace detail

}  // namespace tafoni

#endif
