/// \file
/// The errors that the library throws, and the one place that throws them.
#ifndef TAFONI_CORE_ERROR_HPP
#define TAFONI_CORE_ERROR_HPP

#include <cassert>
#include <charconv>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#if defined(__FAST_MATH__)
#error "tafoni: -ffast-math breaks exact signs and reproducible bits; compile without it"
#endif

/// Checks our own invariants (never the user's input); vanishes with NDEBUG.
#define TAFONI_ASSERT(condition, why) assert((condition) && (why))

namespace tafoni {

/// What went wrong. The numbers are stable: hosts may store and compare them.
enum class errc : std::uint16_t {
    empty_input = 1,
    non_finite_vertex = 2,
    index_out_of_range = 3,
    degenerate_face = 4,
    duplicate_face = 5,
    not_closed = 6,
    nonmanifold_edge = 7,
    nonmanifold_vertex = 8,
    inconsistent_orientation = 9,
    non_orientable = 10,
    inverted_orientation = 11,
    zero_volume = 12,
    self_intersection = 13,
    out_of_range = 14,
    attribute_length = 15,
    no_sites = 20,
    duplicate_sites = 21,
    site_outside = 22,
    non_finite_site = 23,
    bad_box = 24,
    bad_parameter = 30,
    size_overflow = 31,
    no_entry = 32,
    cannot_open = 40,
    not_a_file = 41,
    truncated = 42,
    bad_syntax = 43,
    bad_number = 44,
    bad_count = 45,
    wrong_format = 46,
    unsupported = 47,
    write_failed = 48,
    format_limit = 49,
    missing_property = 50,
    checkpoint_mismatch = 51,
    cancelled = 60,
};

/// The kind of thing that an error points at.
enum class entity : std::uint8_t {
    none, vertex, edge, face, corner, site, cell, link, voxel, parameter, attribute, file
};

/// Where it went wrong. Fields that do not apply keep their defaults.
struct error_place {
    static constexpr std::uint64_t nowhere = std::numeric_limits<std::uint64_t>::max();

    entity kind = entity::none;                            ///< what `index` counts
    std::uint64_t index = nowhere;                         ///< the element, from 0
    std::string file{};                                    ///< path as given by the user
    std::uint64_t line = 0;                                ///< from 1; 0 when there is none
    std::uint64_t column = 0;                              ///< from 1; 0 when there is none
    double value = std::numeric_limits<double>::quiet_NaN();  ///< what we got
    double limit = std::numeric_limits<double>::quiet_NaN();  ///< what it may be at most
};

namespace detail {

/// A standard exception that also carries a code and a place; copying never throws.
template <class Base>
class located_error : public Base {
public:
    located_error(errc code, std::string const& what, error_place place = {})
        : Base(what), code_(code), place_(std::make_shared<error_place const>(std::move(place))) {}

    [[nodiscard]] errc code() const noexcept { return code_; }
    [[nodiscard]] error_place const& place() const noexcept { return *place_; }

private:
    errc code_;
    std::shared_ptr<error_place const> place_;
};

}  // namespace detail

/// A value, parameter or array that the callee cannot accept.
class invalid_input : public detail::located_error<std::invalid_argument> {
    using located_error::located_error;
};

/// A mesh whose connectivity does not bound a solid.
class bad_topology : public detail::located_error<std::invalid_argument> {
    using located_error::located_error;
};

/// A file that cannot be opened, read as its format, or written.
class io_error : public detail::located_error<std::runtime_error> {
    using located_error::located_error;
};

/// The caller asked to stop; what the run had finished is kept.
class cancelled : public detail::located_error<std::runtime_error> {
    using located_error::located_error;
};

namespace detail {

/// The only throw site of the library, so that hosts without exceptions can route it.
template <class Error>
[[noreturn]] void fail(errc code, std::string const& what, error_place place = {}) {
    throw Error(code, what, std::move(place));
}

/// The shortest text that names the number, the same in every locale: 1e-09, not 0.000000.
[[nodiscard]] inline std::string number_text(double value) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

/// Throws `bad_parameter` unless lo <= value <= hi; NaN fails. `name` reads "type.member".
inline void require_range(char const* name, double value, double lo, double hi) {
    if (!(value >= lo && value <= hi)) {
        fail<invalid_input>(errc::bad_parameter,
                            std::string(name) + ": got " + number_text(value) + ", allowed [" + number_text(lo) +
                                ", " + number_text(hi) + "]",
                            {.kind = entity::parameter, .value = value, .limit = value < lo ? lo : hi});
    }
}

}  // namespace detail
}  // namespace tafoni

#endif
