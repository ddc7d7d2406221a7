/// \file
/// Fluids as bytes: what they were told, what they are, and a hash of both.
#ifndef TAFONI_FLUID_DETAIL_FLUID_BYTES_HPP
#define TAFONI_FLUID_DETAIL_FLUID_BYTES_HPP

#include <tafoni/core/detail/bytes.hpp>
#include <tafoni/core/error.hpp>
#include <tafoni/core/vector.hpp>
#include <tafoni/fluid/emitter.hpp>

#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace tafoni::detail {

/// Options, emitters and sinks as numbers that can be compared. Zeros of both signs are equal.
class fluid_settings {
public:
    void add(std::uint64_t v) { words_.push_back(v); }
    void add(double v) { words_.push_back(std::bit_cast<std::uint64_t>(v == 0 ? 0.0 : v)); }
    void add(vec3 const& v) {
        for (int d = 0; d < 3; ++d) add(v[d]);
    }
    void add(box_sink const& s) {
        add(s.keep.lo);
        add(s.keep.hi);
    }
    void add(box_emitter const& e) {
        add(e.box.lo);
        add(e.box.hi);
        add(e.velocity);
    }
    [[nodiscard]] std::vector<std::uint64_t> const& words() const noexcept { return words_; }

private:
    std::vector<std::uint64_t> words_{};
};

template <std::floating_point Scalar>
using word_of = std::conditional_t<sizeof(Scalar) == 4, std::uint32_t, std::uint64_t>;

/// Kind, settings, then what is put, then by `finish` the hash.
class fluid_writer {
public:
    fluid_writer(byte_writer& out, std::uint64_t kind, fluid_settings const& told) : out_(out) {
        put(kind);
        put(std::uint64_t{told.words().size()});
        for (std::uint64_t const w : told.words()) put(w);
    }
    void put(std::uint64_t v) { put(v, 8); }
    template <std::floating_point Scalar>
    void put(Scalar v) {
        put(std::bit_cast<word_of<Scalar>>(v), sizeof(Scalar));
    }
    void put(vec3 const& v) {
        for (int d = 0; d < 3; ++d) put(v[d]);
    }
    void finish() { out_.put(hash_.value()); }

private:
    void put(std::uint64_t v, int bytes) {
        out_.put(v, bytes);
        hash_.add(v);
    }

    byte_writer& out_;
    number_hash hash_{};
};

/// Reads what `fluid_writer` wrote. Nothing that is read may be used before `finish`.
class fluid_reader {
public:
    /// \throws io_error  `truncated`, `wrong_format` for another kind of fluid.
    fluid_reader(byte_reader& in, std::uint64_t kind) : in_(in) {
        if (get() != kind) fail<io_error>(errc::wrong_format, std::string(in_.who()) + ": the saved fluid is of another kind");
        told_.resize(count(8));
        for (std::uint64_t& w : told_) w = get();
    }
    [[nodiscard]] std::uint64_t get() { return get(8); }
    /// How many things follow that take `bytes` each.
    [[nodiscard]] std::size_t count(std::size_t bytes) {
        std::uint64_t const n = get();
        if (n > in_.left() / bytes) fail<io_error>(errc::truncated, std::string(in_.who()) + ": the saved fluid ends early");
        return static_cast<std::size_t>(n);
    }
    /// A finite number.
    template <std::floating_point Scalar>
    void get(Scalar& v) {
        v = std::bit_cast<Scalar>(static_cast<word_of<Scalar>>(get(sizeof(Scalar))));
        if (!std::isfinite(v)) bad("a number is not finite");
    }
    void get(vec3& v) {
        for (int d = 0; d < 3; ++d) get(v[d]);
    }
    /// \throws io_error  `bad_syntax` where bytes have changed; invalid_input  `checkpoint_mismatch` for other settings.
    void finish(fluid_settings const& told) {
        if (in_.get() != hash_.value()) bad("the checksum is wrong");
        if (told_ == told.words()) return;
        fail<invalid_input>(errc::checkpoint_mismatch, std::string(in_.who()) + ": the fluid was saved with other options, emitters or another sink");
    }
    [[noreturn]] void bad(char const* why) const { fail<io_error>(errc::bad_syntax, std::string(in_.who()) + ": saved fluid: " + why); }

private:
    std::uint64_t get(std::size_t bytes) {
        std::uint64_t const v = in_.get(bytes);
        hash_.add(v);
        return v;
    }

    byte_reader& in_;
    number_hash hash_{};
    std::vector<std::uint64_t> told_{};
};

}  // namespace tafoni::detail

#endif
