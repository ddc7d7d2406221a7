/// \file
/// What checkpoints are written with: hashes and little-endian bytes.
#ifndef TAFONI_CORE_DETAIL_BYTES_HPP
#define TAFONI_CORE_DETAIL_BYTES_HPP

#include <tafoni/core/error.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tafoni::detail {

__extension__ using wide_int = __int128;

/// A 64-bit hash of numbers, the same everywhere; not against malice.
class number_hash {
public:
    void add(std::uint64_t v) noexcept {
        h_ = (h_ ^ v) * 0x9E3779B97F4A7C15ULL;
        h_ ^= h_ >> 29;
    }
    void add(double v) noexcept { add(std::bit_cast<std::uint64_t>(v == 0 ? 0.0 : v)); }
    [[nodiscard]] std::uint64_t value() const noexcept {
        std::uint64_t h = h_ * 0xBF58476D1CE4E5B9ULL;
        return h ^ h >> 32;
    }

private:
    std::uint64_t h_ = 0x7461666F6E690001ULL;
};

/// Little-endian bytes, whatever the machine.
class byte_writer {
public:
    void put(std::uint64_t v, int bytes = 8) {
        for (int k = 0; k < bytes; ++k) bytes_.push_back(static_cast<std::byte>(v >> (8 * k) & 0xFF));
    }
    void put(wide_int v) {
        put(static_cast<std::uint64_t>(v));
        put(static_cast<std::uint64_t>(v >> 64));
    }
    void put_real(double v) { put(std::bit_cast<std::uint64_t>(v)); }
    void reserve(std::size_t n) { bytes_.reserve(n); }
    [[nodiscard]] std::vector<std::byte>& bytes() noexcept { return bytes_; }

private:
    std::vector<std::byte> bytes_{};
};

class byte_reader {
public:
    /// `who` begins the text of errors and must outlive the reader.
    byte_reader(std::span<std::byte const> bytes, char const* who) noexcept : bytes_(bytes), who_(who) {}
    [[nodiscard]] std::uint64_t get(std::size_t bytes = 8) {
        if (bytes_.size() - at_ < bytes) {
            fail<io_error>(errc::truncated, std::string(who_) + ": the checkpoint ends early");
        }
        std::uint64_t v = 0;
        for (std::size_t k = 0; k < bytes; ++k) v |= std::to_integer<std::uint64_t>(bytes_[at_ + k]) << (8 * k);
        at_ += bytes;
        return v;
    }
    [[nodiscard]] wide_int get_wide() {
        std::uint64_t const low = get();
        auto const high = static_cast<std::int64_t>(get());
        return wide_int{high} * (wide_int{1} << 64) + static_cast<wide_int>(low);
    }
    /// A finite number.
    [[nodiscard]] double get_real() {
        auto const v = std::bit_cast<double>(get());
        if (!(v > -1e300 && v < 1e300)) fail<io_error>(errc::bad_syntax, std::string(who_) + ": a number is out of range");
        return v;
    }
    [[nodiscard]] char const* who() const noexcept { return who_; }
    [[nodiscard]] std::size_t left() const noexcept { return bytes_.size() - at_; }

private:
    std::span<std::byte const> bytes_;
    char const* who_;
    std::size_t at_ = 0;
};

[[nodiscard]] inline std::uint64_t byte_hash(std::span<std::byte const> bytes) noexcept {
    number_hash h;
    std::size_t k = 0;
    for (; k + 8 <= bytes.size(); k += 8) {
        std::uint64_t v = 0;
        for (std::size_t j = 0; j < 8; ++j) v |= std::to_integer<std::uint64_t>(bytes[k + j]) << (8 * j);
        h.add(v);
    }
    for (; k < bytes.size(); ++k) h.add(std::to_integer<std::uint64_t>(bytes[k]));
    return h.value();
}

}  // namespace tafoni::detail

#endif
