/// \file
/// Reads a durability profile from a small text file.
#ifndef TAFONI_IO_READ_DURABILITY_HPP
#define TAFONI_IO_READ_DURABILITY_HPP

#include <tafoni/field/durability_profile.hpp>
#include <tafoni/io/detail/load_file.hpp>
#include <tafoni/io/detail/parse_number.hpp>
#include <tafoni/io/detail/source_text.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tafoni {

/// What the file says.
struct durability_table {
    bool relative = false;  ///< altitudes are shares of the model's height: place them by `scaled_durability`
    std::vector<durability_point> points{};  ///< ascending, at least one
};

namespace detail {

class durability_parser {
public:
    explicit durability_parser(source_text const& source)
        : source_(source), at_(source.require_text()), end_(source.end()) {}

    durability_table parse() {
        for (;;) {
            while (at_ != end_ && is_space(*at_)) ++at_;
            if (at_ == end_) break;
            if (*at_ == '#') skip_line();
            else if (!header()) row();
        }
        if (out_.points.empty()) {
            source_.fail_at(at_, errc::empty_input, "expected lines of altitude and durability, got none");
        }
        return std::move(out_);
    }

private:
    void skip_line() {
        while (at_ != end_ && !is_line_end(*at_)) ++at_;
    }

    /// `relative` or `absolute`, alone in its line, before the first point.
    bool header() {
        for (std::string_view const word : {"relative", "absolute"}) {
            if (std::string_view(at_, static_cast<std::size_t>(end_ - at_)).substr(0, word.size()) != word) continue;
            char const* const start = at_;
            at_ += word.size();
            if (seen_header_) source_.fail_at(start, errc::bad_syntax, "the kind of altitudes is given twice");
            if (!out_.points.empty()) {
                source_.fail_at(start, errc::bad_syntax, std::string(word) + " must stand before the first point");
            }
            out_.relative = word == "relative";
            seen_header_ = true;
            if (!line_is_over()) source_.fail_at(at_, errc::bad_syntax, "expected the end of the line, got " + source_.token(at_));
            return true;
        }
        return false;
    }

    void row() {
        static constexpr std::array<char const*, 4> names{"an altitude", "a durability", "an amplitude", "a frequency"};
        std::array<double, 4> numbers{};
        std::array<char const*, 4> places{};
        std::size_t count = 0;
        while (!line_is_over()) {
            if (count == 4) source_.fail_at(at_, errc::bad_count, "expected at most 4 numbers in a line, got " + source_.token(at_));
            places[count] = at_;
            parsed_number const r = parse_double(at_, end_);
            bool const ends = r.state == number_state::ok && (r.next == end_ || is_space(*r.next) || *r.next == '#');
            if (!ends || !std::isfinite(r.value)) {
                source_.fail_at(at_, errc::bad_number, std::string("expected ") + names[count] + ", got " + source_.token(at_));
            }
            numbers[count++] = r.value;
            at_ = r.next;
        }
        if (count != 2 && count != 4) {
            source_.fail_at(at_, errc::bad_count,
                            "expected altitude durability, or altitude durability amplitude frequency, got " +
                                std::to_string(count) + (count == 1 ? " number" : " numbers"));
        }
        for (std::size_t k = 0; k < count; ++k) {
            double const least = k == 0 ? -1e150 : 0;
            if (!(numbers[k] >= least && numbers[k] <= 1e150)) {
                source_.fail_at(places[k], errc::bad_number,
                                std::string("expected ") + names[k] + (k == 0 ? " of at most 1e150" : " of at least 0") +
                                    ", got " + source_.token(places[k]),
                                {.value = numbers[k], .limit = numbers[k] < least ? least : 1e150});
            }
        }
        if (!out_.points.empty() && !(numbers[0] >= out_.points.back().altitude)) {
            source_.fail_at(places[0], errc::bad_syntax,
                            "altitudes must ascend, got " + source_.token(places[0]) + " after " +
                                number_text(out_.points.back().altitude),
                            {.value = numbers[0], .limit = out_.points.back().altitude});
        }
        out_.points.push_back({numbers[0], numbers[1], numbers[2], numbers[3]});
    }

    /// Skips blanks, and a comment.
    bool line_is_over() {
        while (at_ != end_ && is_blank(*at_)) ++at_;
        if (at_ != end_ && *at_ == '#') skip_line();
        return at_ == end_ || is_line_end(*at_);
    }

    source_text const& source_;
    char const* at_;
    char const* end_;
    bool seen_header_ = false;
    durability_table out_{};
};

}  // namespace detail

/// Reads a durability profile from memory; `name` stands in for the path in errors. O(bytes).
///
/// One corner of the curve per line, from below: `altitude durability [amplitude frequency]`, the noise
/// holding up to the next corner. `#` starts a comment. A line `relative` before the first corner says that
/// altitudes are shares of the model's height, 0 at its bottom and 1 at its top, and that frequencies count
/// noise cells over that height; `absolute` (the default) that both are in the unit of the model.
///
///     relative
///     0    0.02              # soft base
///     0.3  0.02  0.01  12    # ... with noise from here
///     0.3  0.08              # step: a hard ledge
///     1    0.05
///
/// \throws io_error  naming line and column: `bad_syntax`, `bad_number`, `bad_count`, `wrong_format`, `empty_input`.
[[nodiscard]] inline durability_table read_durability(std::string_view bytes, std::string_view name) {
    detail::source_text const source{"read_durability", bytes, name};
    return detail::durability_parser(source).parse();
}

/// Reads a durability profile file. \throws io_error  as above, and `cannot_open`, `not_a_file`.
[[nodiscard]] inline durability_table read_durability(std::filesystem::path const& path) {
    detail::loaded_file const file = detail::load_file("read_durability", path);
    return read_durability(file.bytes(), path.string());
}

}  // namespace tafoni

#endif
