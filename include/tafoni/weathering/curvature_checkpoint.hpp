/// \file
/// The bytes that a curvature run is saved as and goes on from.
#ifndef TAFONI_WEATHERING_CURVATURE_CHECKPOINT_HPP
#define TAFONI_WEATHERING_CURVATURE_CHECKPOINT_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/geometry/triangle_surface.hpp>
#include <tafoni/weathering/curvature_weathering.hpp>
#include <tafoni/weathering/detail/checkpoint_bytes.hpp>
#include <tafoni/weathering/detail/surface_hash.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tafoni::detail {

/// What a curvature run is between two iterations, in the door's frame.
struct curvature_state {
    triangle_surface surface{};
    std::vector<vertex_index> new_vertex{};  ///< vertex of the input -> vertex now
    std::vector<double> wear{};
    std::vector<vertex_index> input_of{};    ///< vertex now -> that of the input it still is, or not valid
    std::vector<unsigned char> held{};       ///< vertex now -> whether it is held still; empty: none is
    std::uint64_t iterations = 0;
    std::uint64_t edges_collapsed = 0;
};

/// What a checkpoint holds: the state, that after the last sound search for cuts, and the step.
struct curvature_checkpoint {
    curvature_state now{};
    curvature_state safe{};   ///< empty where no searches are made
    std::uint64_t retries = 0;
    std::uint64_t holds = 0;  ///< since the last sound search
    double step = 0;
};

/// Options and policies; durability as it answers at the vertices of the input. O(vertices).
template <class Process>
[[nodiscard]] std::uint64_t parameter_hash(Process const& process, curvature_options const& o, std::span<vec3 const> input) {
    number_hash h;
    for (double const v : {o.power, o.step_divisor, o.small_edge}) h.add(v);
    for (auto const v : {static_cast<std::uint64_t>(o.topology), std::uint64_t{o.check_every}, std::uint64_t{o.retries},
                         std::uint64_t{o.hold_after}}) h.add(v);
    add_policy(h, process.estimator);
    add_policy(h, process.direction);
    for (vec3 const& p : input) h.add(static_cast<double>(process.durability(p)));
    return h.value();
}

inline constexpr std::uint64_t curvature_checkpoint_magic = 0x7275632D66617400ULL;  // "\0taf-cur"
inline constexpr std::uint64_t curvature_checkpoint_version = 2;

inline void put_state(byte_writer& out, curvature_state const& s) {
    for (std::size_t const n : {s.surface.positions.size(), s.surface.triangles.size(), s.new_vertex.size()}) out.put(n);
    for (vec3 const& p : s.surface.positions) {
        for (int d = 0; d < 3; ++d) out.put(std::bit_cast<std::uint64_t>(p[d]));
    }
    for (auto const& t : s.surface.triangles) {
        for (std::uint32_t const c : t) out.put(c, 4);
    }
    for (vertex_index const v : s.new_vertex) out.put(v.value, 4);
    for (double const w : s.wear) out.put(std::bit_cast<std::uint64_t>(w));
    for (vertex_index const v : s.input_of) out.put(v.value, 4);
    out.put(s.held.empty() ? 0 : 1, 1);
    for (unsigned char const c : s.held) out.put(c, 1);
    out.put(s.iterations);
    out.put(s.edges_collapsed);
}

/// Magic, version, hashes of the input and of the parameters, step, retries, holds, one or two states, hash. O(vertices + faces).
[[nodiscard]] inline std::vector<std::byte> write_checkpoint(curvature_checkpoint const& c, std::uint64_t input,
                                                             std::uint64_t parameters) {
    byte_writer out;
    out.reserve(256 + 61 * (c.now.surface.positions.size() + c.safe.surface.positions.size()) +
                12 * (c.now.surface.triangles.size() + c.safe.surface.triangles.size()));
    out.put(curvature_checkpoint_magic);
    out.put(curvature_checkpoint_version, 4);
    out.put(input);
    out.put(parameters);
    out.put(std::bit_cast<std::uint64_t>(c.step));
    out.put(c.retries);
    out.put(c.holds);
    put_state(out, c.now);
    put_state(out, c.safe);
    out.put(byte_hash(out.bytes()));
    return std::move(out.bytes());
}

/// Checks everything that is read. `inputs` is the number of vertices that the run began with.
class curvature_checkpoint_reader {
public:
    curvature_checkpoint_reader(std::span<std::byte const> bytes, std::size_t inputs) : bytes_(bytes), in_(bytes, who), inputs_(inputs) {}

    /// \throws io_error  `wrong_format`, `unsupported`, `checkpoint_mismatch`, `truncated`, `bad_syntax`. O(bytes).
    [[nodiscard]] curvature_checkpoint read(std::uint64_t input, std::uint64_t parameters) {
        if (bytes_.size() < 8 || in_.get() != curvature_checkpoint_magic) {
            fail<io_error>(errc::wrong_format, std::string(who) + ": these bytes are no curvature checkpoint");
        }
        if (std::uint64_t const version = in_.get(4); version != curvature_checkpoint_version) {
            fail<io_error>(errc::unsupported, std::string(who) + ": checkpoint version " + std::to_string(version) +
                                                  ", this library reads " + std::to_string(curvature_checkpoint_version));
        }
        if (in_.get() != input) fail<io_error>(errc::checkpoint_mismatch, std::string(who) + ": the checkpoint belongs to another mesh");
        if (in_.get() != parameters) {
            fail<io_error>(errc::checkpoint_mismatch, std::string(who) + ": the checkpoint was made with other parameters");
        }
        byte_reader end(bytes_.last(8), who);
        if (end.get() != byte_hash(bytes_.first(bytes_.size() - 8))) bad("the checksum is wrong");
        curvature_checkpoint c;
        c.step = real();
        if (!(c.step > 0 && c.step <= 1)) bad("the step is out of range");
        c.retries = in_.get();
        c.holds = in_.get();
        c.now = state();
        c.safe = state();
        if (c.now.new_vertex.size() != inputs_) bad("the counts do not fit the mesh");
        if (in_.left() != 8) bad("bytes follow the end");
        return c;
    }

private:
    static constexpr char const* who = "curvature_run::resume";

    [[noreturn]] static void bad(char const* why) { fail<io_error>(errc::bad_syntax, std::string(who) + ": " + why); }

    [[nodiscard]] double real() {
        double const d = std::bit_cast<double>(in_.get());
        if (!(d > -1e300 && d < 1e300)) bad("a number is out of range");
        return d;
    }
    [[nodiscard]] vertex_index vertex(std::size_t below) {
        vertex_index v;
        v.value = static_cast<std::uint32_t>(in_.get(4));
        if (v.value >= below) bad("a vertex is out of range");
        return v;
    }

    [[nodiscard]] bool flag() {
        std::uint64_t const f = in_.get(1);
        if (f > 1) bad("a flag is neither 0 nor 1");
        return f == 1;
    }

    [[nodiscard]] curvature_state state() {
        curvature_state s;
        std::uint64_t const n = in_.get();
        std::uint64_t const faces = in_.get();
        std::uint64_t const inputs = in_.get();
        bool const none = n == 0 && faces == 0 && inputs == 0;
        if (!none && inputs != inputs_) bad("the counts do not fit the mesh");
        if (n > inputs_ || faces > in_.left() / 12 || n > in_.left() / 24) bad("there are fewer bytes than vertices and faces");
        s.surface.positions.resize(static_cast<std::size_t>(n));
        for (vec3& p : s.surface.positions) {
            for (int d = 0; d < 3; ++d) p[d] = real();
        }
        s.surface.triangles.resize(static_cast<std::size_t>(faces));
        for (auto& t : s.surface.triangles) {
            for (std::uint32_t& c : t) c = vertex(s.surface.positions.size()).value;
        }
        s.new_vertex.resize(static_cast<std::size_t>(inputs));
        for (vertex_index& v : s.new_vertex) v = vertex(s.surface.positions.size());
        s.wear.resize(s.surface.positions.size());
        for (double& w : s.wear) {
            w = real();
            if (w < 0) bad("a wear is negative");
        }
        s.input_of.resize(s.surface.positions.size());
        for (vertex_index& v : s.input_of) {
            v.value = static_cast<std::uint32_t>(in_.get(4));
            if (v.valid() && v.value >= inputs_) bad("a vertex is out of range");
        }
        if (flag()) s.held.resize(s.surface.positions.size());
        for (unsigned char& c : s.held) c = flag() ? 1 : 0;
        s.iterations = in_.get();
        s.edges_collapsed = in_.get();
        return s;
    }

    std::span<std::byte const> bytes_;
    byte_reader in_;
    std::size_t inputs_;
};

}  // namespace tafoni::detail

#endif
