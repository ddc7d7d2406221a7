/// \file
/// Reads pictures in shades of grey, as portable graymaps (.pgm).
#ifndef TAFONI_IO_READ_PGM_HPP
#define TAFONI_IO_READ_PGM_HPP

#include <tafoni/io/detail/load_file.hpp>
#include <tafoni/io/detail/parse_number.hpp>
#include <tafoni/io/detail/source_text.hpp>
#include <tafoni/voxel/gray_image.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tafoni {
namespace detail {

class pgm_parser {
public:
    explicit pgm_parser(source_text const& source) : source_(source), at_(source.begin()), end_(source.end()) {
        source.require_plain();
    }

    gray_image parse() {
        bool const raw = magic();
        out_.width = header_number("the width", 0x7fffffffU);
        out_.height = header_number("the height", 0x7fffffffU);
        most_ = header_number("the value of white", 65535);
        std::uint64_t const count = std::uint64_t{out_.width} * out_.height;  // below 2^62
        if (raw) {
            samples_of(count);
        } else {
            numbers(count);
        }
        return std::move(out_);
    }

private:
    /// Returns whether the samples are bytes.
    bool magic() {
        if (source_.bytes.size() >= 2 && *at_ == 'P' && (at_[1] == '2' || at_[1] == '5')) {
            at_ += 2;
            return at_[-1] == '5';
        }
        if (source_.bytes.size() >= 2 && *at_ == 'P' && at_[1] >= '1' && at_[1] <= '7') {
            source_.fail_at(at_, errc::unsupported,
                            "expected a portable graymap, P2 or P5, got " + std::string(at_, 2) +
                                "; convert it to shades of grey first");
        }
        source_.fail_at(at_, errc::wrong_format, "expected P2 or P5, got " + source_.token(at_));
    }

    /// Skips blanks, and comments to the end of their line.
    void skip() {
        while (at_ != end_ && (is_space(*at_) || *at_ == '#')) {
            if (*at_ != '#') {
                ++at_;
                continue;
            }
            while (at_ != end_ && !is_line_end(*at_)) ++at_;
        }
    }

    std::uint32_t whole_number(char const* what, std::uint32_t limit) {
        skip();
        if (at_ == end_) source_.fail_at(at_, errc::truncated, std::string("expected ") + what + ", got end of file");
        parsed_integer const r = parse_integer(at_, end_);
        bool const complete = r.state != number_state::malformed && (r.next == end_ || is_space(*r.next) || *r.next == '#');
        if (!complete || r.state != number_state::ok || r.negative || r.magnitude > limit) {
            source_.fail_at(at_, errc::bad_number,
                            std::string("expected ") + what + ", at most " + std::to_string(limit) + ", got " +
                                source_.token(at_));
        }
        at_ = r.next;
        return static_cast<std::uint32_t>(r.magnitude);
    }
    std::uint32_t header_number(char const* what, std::uint32_t limit) {
        skip();
        char const* const place = at_;
        std::uint32_t const n = whole_number(what, limit);
        if (n == 0) source_.fail_at(place, errc::bad_count, std::string("expected ") + what + " above 0, got 0");
        return n;
    }

    [[nodiscard]] std::uint8_t grey(std::uint32_t value) const noexcept {
        return static_cast<std::uint8_t>((255 * value + most_ / 2) / most_);
    }

    void samples_of(std::uint64_t count) {
        if (at_ == end_ || !is_space(*at_)) {
            source_.fail_at(at_, at_ == end_ ? errc::truncated : errc::bad_syntax,
                            "expected one blank before the samples, got " + source_.token(at_));
        }
        ++at_;
        std::uint64_t const width = most_ > 255 ? 2 : 1;
        auto const left = static_cast<std::uint64_t>(end_ - at_);
        if (left != count * width) {
            source_.fail_at_byte(at_, left < count * width ? errc::truncated : errc::bad_count,
                                 "expected " + std::to_string(count * width) + " bytes of samples, got " +
                                     std::to_string(left));
        }
        out_.pixels.reserve(count);
        for (; at_ != end_; at_ += width) {
            auto const byte = [&](std::size_t k) { return static_cast<std::uint32_t>(static_cast<unsigned char>(at_[k])); };
            std::uint32_t const value = width == 2 ? 256 * byte(0) + byte(1) : byte(0);
            if (value > most_) {
                source_.fail_at_byte(at_, errc::out_of_range,
                                     "expected a sample of at most " + std::to_string(most_) + ", got " +
                                         std::to_string(value),
                                     {.value = static_cast<double>(value), .limit = static_cast<double>(most_)});
            }
            out_.pixels.push_back(grey(value));
        }
    }

    void numbers(std::uint64_t count) {
        std::uint64_t const room = static_cast<std::uint64_t>(end_ - at_) / 2 + 1;
        if (count > room) {
            source_.fail_at(at_, errc::bad_count,
                            "expected " + std::to_string(count) + " samples, but only " + std::to_string(end_ - at_) +
                                " bytes follow");
        }
        out_.pixels.reserve(count);
        for (std::uint64_t i = 0; i < count; ++i) out_.pixels.push_back(grey(whole_number("a sample", most_)));
        skip();
        if (at_ != end_) {
            source_.fail_at(at_, errc::bad_count,
                            "expected the end of the file behind " + std::to_string(count) + " samples, got " +
                                source_.token(at_));
        }
    }

    source_text const& source_;
    char const* at_;
    char const* end_;
    std::uint32_t most_ = 255;
    gray_image out_{};
};

}  // namespace detail

/// Reads a graymap from memory; `name` stands in for the path in errors. O(bytes).
///
/// P2 (numbers) and P5 (bytes, of 16 bits with the high byte first); `#` comments. The value of white may be
/// 1 to 65535: samples are scaled to 0 .. 255 and rounded. Files of several images are refused.
/// \throws io_error  naming line and column, or the byte: `bad_number`, `bad_count`, `bad_syntax`,
///                   `out_of_range`, `truncated`, `unsupported`, `wrong_format`, `empty_input`.
[[nodiscard]] inline gray_image read_pgm(std::string_view bytes, std::string_view name) {
    detail::source_text const source{"read_pgm", bytes, name};
    return detail::pgm_parser(source).parse();
}

/// Reads a graymap file. \throws io_error  as above, and `cannot_open`, `not_a_file`.
[[nodiscard]] inline gray_image read_pgm(std::filesystem::path const& path) {
    detail::loaded_file const file = detail::load_file("read_pgm", path);
    return read_pgm(file.bytes(), path.string());
}

}  // namespace tafoni

#endif
