/// \file
/// Reads elevation models in ESRI ASCII grid form (.asc).
#ifndef TAFONI_IO_ESRI_ASCII_HPP
#define TAFONI_IO_ESRI_ASCII_HPP

#include <tafoni/geometry/height_grid.hpp>
#include <tafoni/io/detail/load_file.hpp>
#include <tafoni/io/detail/parse_number.hpp>
#include <tafoni/io/detail/source_text.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>

namespace tafoni {
namespace detail {

class esri_ascii_parser {
public:
    explicit esri_ascii_parser(source_text const& source)
        : source_(source), at_(source.require_text()), end_(source.end()) {}

    height_grid parse() {
        header();
        heights();
        return std::move(out_);
    }

private:
    enum key : std::size_t { ncols, nrows, xllcorner, yllcorner, xllcenter, yllcenter, cellsize, dx, dy, nodata, keys };
    static constexpr std::array<std::string_view, keys> names{"ncols",     "nrows",    "xllcorner", "yllcorner", "xllcenter",
                                                              "yllcenter", "cellsize", "dx",        "dy",        "nodata_value"};

    void header() {
        for (skip_spaces(); at_ != end_ && is_letter(*at_); skip_spaces()) {
            char const* const start = at_;
            std::string word;
            while (at_ != end_ && !is_space(*at_) && word.size() < 16) {
                word += *at_ >= 'A' && *at_ <= 'Z' ? static_cast<char>(*at_ + ('a' - 'A')) : *at_;
                ++at_;
            }
            std::size_t k = 0;
            while (k < keys && names[k] != word) ++k;
            if (k == keys) {
                // A grid whose first height is nan or inf: the header is over.
                if ((word == "nan" || word == "inf") && place_[ncols] != nullptr && place_[nrows] != nullptr) {
                    at_ = start;
                    break;
                }
                source_.fail_at(start, errc::bad_syntax,
                                "expected ncols, nrows, xllcorner, yllcorner, cellsize or NODATA_value, got " +
                                    source_.token(start));
            }
            if (place_[k] != nullptr) source_.fail_at(start, errc::bad_syntax, word + " is given twice");
            place_[k] = start;
            while (at_ != end_ && is_blank(*at_)) ++at_;
            if (k == ncols || k == nrows) {
                (k == ncols ? out_.columns : out_.rows) = dimension();
            } else {
                value_[k] = number(k == nodata);
            }
        }
        if (place_[ncols] == nullptr || place_[nrows] == nullptr) {
            source_.fail_at(at_, errc::bad_syntax, "expected ncols and nrows before the heights, got " + source_.token(at_));
        }
        bool const centre = place_[xllcenter] != nullptr;
        if (centre != (place_[yllcenter] != nullptr) || (place_[xllcorner] != nullptr) != (place_[yllcorner] != nullptr) ||
            centre == (place_[xllcorner] != nullptr)) {
            source_.fail_at(at_, errc::bad_syntax, "expected xllcorner and yllcorner, or xllcenter and yllcenter");
        }
        out_.registration = centre ? grid_registration::centre : grid_registration::corner;
        out_.lower_left_x = value_[centre ? xllcenter : xllcorner];
        out_.lower_left_y = value_[centre ? yllcenter : yllcorner];
        bool const square = place_[cellsize] != nullptr;
        out_.cell_size_x = cell(square ? cellsize : dx);
        out_.cell_size_y = cell(square ? cellsize : dy);
        has_nodata_ = place_[nodata] != nullptr;
    }

    double cell(key k) const {
        if (place_[k] == nullptr) source_.fail_at(at_, errc::bad_syntax, "expected cellsize, or dx and dy");
        if (!(value_[k] > 0)) {
            source_.fail_at(place_[k], errc::bad_number, "expected a cell size above 0, got " + number_text(value_[k]),
                            {.value = value_[k], .limit = 0});
        }
        return value_[k];
    }

    std::size_t dimension() {
        parsed_integer const r = parse_integer(at_, end_);
        bool const complete = r.state != number_state::malformed && (r.next == end_ || is_space(*r.next));
        if (!complete || r.negative || r.magnitude == 0 || r.magnitude > 0xffffffffU) {
            source_.fail_at(at_, errc::bad_count, "expected how many cells, from 1 to 4294967295, got " + source_.token(at_));
        }
        at_ = r.next;
        return static_cast<std::size_t>(r.magnitude);
    }

    void heights() {
        std::uint64_t const count = static_cast<std::uint64_t>(out_.columns) * out_.rows;  // both have 32 bits
        std::uint64_t const room = static_cast<std::uint64_t>(end_ - at_) / 2 + 1;
        if (count > room) {
            source_.fail_at(place_[ncols], errc::bad_count,
                            "expected " + std::to_string(out_.columns) + " x " + std::to_string(out_.rows) +
                                " heights, but only " + std::to_string(end_ - at_) + " bytes follow");
        }
        out_.heights.reserve(count);
        char const* line = at_;
        bool row_per_line = true;
        for (std::uint64_t i = 0; i < count; ++i) {
            bool const broken = skip_spaces();
            std::uint64_t const column = i % out_.columns;
            if (i != 0 && i <= out_.columns && broken != (column == 0)) row_per_line = false;
            if (i > out_.columns && row_per_line && broken != (column == 0)) {
                source_.fail_at(broken ? at_ : line, errc::bad_count,
                                "expected " + std::to_string(out_.columns) + " heights in each row, but row " +
                                    std::to_string(i / out_.columns - (column == 0 ? 1 : 0)) + " has " +
                                    (broken ? std::to_string(column) : std::string("more")));
            }
            if (broken) line = at_;
            if (at_ == end_) {
                source_.fail_at(at_, errc::truncated,
                                "expected " + std::to_string(count) + " heights, got " + std::to_string(i));
            }
            char const* const place = at_;
            double const height = number(true);
            bool const is_missing = has_nodata_ && (height == value_[nodata] ||
                                                    (std::isnan(height) && std::isnan(value_[nodata])));
            if (!is_missing && !std::isfinite(height)) {
                source_.fail_at(place, errc::non_finite_vertex, "expected a finite height, got " + source_.token(place));
            }
            if (is_missing && out_.missing.empty()) out_.missing.resize(count, 0);
            if (is_missing) out_.missing[i] = 1;
            out_.heights.push_back(height);
        }
        skip_spaces();
        if (at_ != end_) {
            source_.fail_at(at_, errc::bad_count,
                            "expected the end of the file behind " + std::to_string(count) + " heights, got " + source_.token(at_));
        }
    }

    double number(bool any) {
        parsed_number const r = parse_double(at_, end_);
        if (r.state != number_state::ok || (r.next != end_ && !is_space(*r.next)) || !(any || std::isfinite(r.value))) {
            source_.fail_at(at_, errc::bad_number, "expected a number, got " + source_.token(at_));
        }
        at_ = r.next;
        return r.value;
    }

    /// Returns whether a line ended.
    bool skip_spaces() {
        bool ended = false;
        for (; at_ != end_ && is_space(*at_); ++at_) ended = ended || is_line_end(*at_);
        return ended;
    }
    [[nodiscard]] static bool is_letter(char c) noexcept { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

    source_text const& source_;
    char const* at_;
    char const* end_;
    std::array<char const*, keys> place_{};
    std::array<double, keys> value_{};
    bool has_nodata_ = false;
    height_grid out_{};
};

}  // namespace detail

/// Reads an ESRI ASCII grid from memory; `name` stands in for the path in errors. O(bytes).
///
/// Header keys in any order and case: ncols, nrows, xllcorner and yllcorner (or the centers),
/// cellsize (or dx and dy), optionally NODATA_value, without which every height must be finite.
/// Missing cells keep the NODATA value in `heights`. If the first line of heights is a whole row,
/// every line must be; else heights flow freely. Lengths are taken as written: a grid in degrees
/// has to be projected first, nothing in the file says that it is one.
/// \throws io_error  naming line and column: `bad_syntax`, `bad_number`, `bad_count`, `truncated`,
///                   `non_finite_vertex`, `wrong_format`, `empty_input`.
[[nodiscard]] inline height_grid read_esri_ascii(std::string_view bytes, std::string_view name) {
    detail::source_text const source{"read_esri_ascii", bytes, name};
    return detail::esri_ascii_parser(source).parse();
}

/// Reads an ESRI ASCII grid file. \throws io_error  as above, and `cannot_open`, `not_a_file`.
[[nodiscard]] inline height_grid read_esri_ascii(std::filesystem::path const& path) {
    detail::loaded_file const file = detail::load_file("read_esri_ascii", path);
    return read_esri_ascii(file.bytes(), path.string());
}

}  // namespace tafoni

#endif
