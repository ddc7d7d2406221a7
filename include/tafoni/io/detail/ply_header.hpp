/// \file
/// The header of a PLY file: which elements follow, with which properties, in which encoding.
#ifndef TAFONI_IO_DETAIL_PLY_HEADER_HPP
#define TAFONI_IO_DETAIL_PLY_HEADER_HPP

#include <tafoni/core/vector.hpp>
#include <tafoni/io/detail/parse_number.hpp>
#include <tafoni/io/detail/source_text.hpp>
#include <tafoni/io/mesh_file.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tafoni {

/// How the numbers of a PLY body are written.
enum class ply_encoding : std::uint8_t { ascii, little_endian, big_endian };

namespace detail {

/// Bytes of one value.
[[nodiscard]] inline std::size_t size_of(channel_type t) noexcept {
    static constexpr std::uint8_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(t)];
}
[[nodiscard]] inline bool is_integer(channel_type t) noexcept { return t < channel_type::float32; }

struct integer_range {
    double lo;
    double hi;
};
[[nodiscard]] inline integer_range range_of(channel_type t) noexcept {
    static constexpr integer_range ranges[] = {{-128, 127},     {0, 255},      {-32768, 32767},
                                               {0, 65535}, {-2147483648.0, 2147483647.0}, {0, 4294967295.0}};
    return ranges[static_cast<std::size_t>(t)];
}

struct ply_property {
    std::string name{};
    channel_type type = channel_type::float32;        ///< of the value, or of a list's items
    channel_type count_type = channel_type::uint8;    ///< of a list's length
    bool is_list = false;
};

struct ply_element {
    std::string name{};
    std::uint64_t count = 0;
    std::vector<ply_property> properties{};
    char const* place = nullptr;  ///< where the header declares it
};

struct ply_header {
    ply_encoding encoding = ply_encoding::ascii;
    std::vector<ply_element> elements{};
    vec3 origin{0, 0, 0};         ///< of the comment "tafoni origin x y z"
    char const* body = nullptr;
};

/// Splits header lines into words.
class ply_header_parser {
public:
    explicit ply_header_parser(source_text const& source) : source_(source), at_(source.begin()) {}

    ply_header parse() {
        source_.require_plain();
        next_line();
        if (line_ != "ply") source_.fail_at(start_, errc::wrong_format, "expected 'ply', got " + source_.token(start_));
        carriage_return_only_ = at_[-1] == '\r';
        bool has_format = false;
        for (;;) {
            next_line();
            std::string_view const keyword = word();
            if (keyword == "end_header") break;
            if (keyword == "format") {
                format(has_format);
            } else if (keyword == "comment") {
                comment();
            } else if (keyword == "element") {
                element();
            } else if (keyword == "property") {
                property();
            } else if (keyword != "obj_info") {
                fail_here(errc::bad_syntax, "expected format, comment, obj_info, element, property or end_header");
            }
            if (keyword != "comment" && keyword != "obj_info" && !word().empty()) {
                fail_here(errc::bad_syntax, "expected the end of the line");
            }
        }
        if (!has_format) source_.fail_at(start_, errc::bad_syntax, "expected a 'format' line before end_header");
        header_.body = at_;
        return std::move(header_);
    }

private:
    static constexpr std::size_t most_properties = 1024;  // bounds the memory that a header alone can take

    void format(bool& has_format) {
        std::string_view const encoding = word();
        if (has_format) fail_here(errc::bad_syntax, "expected one 'format' line only");
        if (encoding == "ascii") {
            header_.encoding = ply_encoding::ascii;
        } else if (encoding == "binary_little_endian") {
            header_.encoding = ply_encoding::little_endian;
        } else if (encoding == "binary_big_endian") {
            header_.encoding = ply_encoding::big_endian;
        } else {
            fail_here(errc::bad_syntax, "expected ascii, binary_little_endian or binary_big_endian");
        }
        if (word() != "1.0") fail_here(errc::unsupported, "expected version 1.0");
        has_format = true;
    }

    void comment() {
        if (word() != "tafoni" || word() != "origin") return;
        for (int axis = 0; axis < 3; ++axis) {
            std::string_view const text = word();
            parsed_number const r = parse_float(text.data(), text.data() + text.size());
            if (r.state != number_state::ok || r.next != text.data() + text.size() || !std::isfinite(r.value)) {
                fail_here(errc::bad_number, "expected the origin's three finite numbers");
            }
            header_.origin[axis] = r.value;
        }
    }

    void element() {
        if (++declared_ > most_properties) fail_here(errc::unsupported, "more than 1024 elements and properties");
        ply_element e;
        e.name = std::string(word());
        e.place = word_;
        std::string_view const count = word();
        parsed_integer const r = parse_integer(count.data(), count.data() + count.size());
        if (r.state == number_state::malformed || r.negative || r.next != count.data() + count.size()) {
            fail_here(errc::bad_count, "expected how many elements follow");
        }
        if (r.state == number_state::overflow) fail_here(errc::bad_count, "expected a count that fits 64 bits");
        for (ply_element const& other : header_.elements) {
            if (other.name == e.name) fail_here(errc::bad_syntax, "element " + e.name + " is declared twice");
        }
        e.count = r.magnitude;
        header_.elements.push_back(std::move(e));
    }

    void property() {
        if (++declared_ > most_properties) fail_here(errc::unsupported, "more than 1024 elements and properties");
        if (header_.elements.empty()) fail_here(errc::bad_syntax, "expected an element before its properties");
        ply_property p;
        std::string_view first = word();
        if (first == "list") {
            p.is_list = true;
            p.count_type = type(word());
            if (!is_integer(p.count_type)) fail_here(errc::bad_syntax, "expected an integer type for a list's length");
            first = word();
        }
        p.type = type(first);
        p.name = std::string(word());
        if (p.name.empty()) fail_here(errc::bad_syntax, "expected the property's name");
        std::vector<ply_property>& list = header_.elements.back().properties;
        for (ply_property const& other : list) {
            if (other.name == p.name) fail_here(errc::bad_syntax, "property " + p.name + " is declared twice");
        }
        list.push_back(std::move(p));
    }

    channel_type type(std::string_view name) {
        static constexpr std::string_view names[8][2] = {{"char", "int8"},   {"uchar", "uint8"}, {"short", "int16"},
                                                         {"ushort", "uint16"}, {"int", "int32"},   {"uint", "uint32"},
                                                         {"float", "float32"}, {"double", "float64"}};
        for (std::size_t k = 0; k < 8; ++k) {
            if (name == names[k][0] || name == names[k][1]) return static_cast<channel_type>(k);
        }
        fail_here(errc::bad_syntax, "expected a type (char, uchar, short, ushort, int, uint, float, double)");
    }

    void next_line() {
        start_ = at_;
        while (at_ != source_.end() && !is_line_end(*at_)) ++at_;
        if (at_ == source_.end()) source_.fail_at(start_, errc::truncated, "the header ends without end_header");
        line_ = std::string_view(start_, static_cast<std::size_t>(at_ - start_));
        word_ = start_;
        // In a file whose lines end with CR alone, an LF behind end_header is already data.
        char const ending = *at_++;
        if (ending == '\r' && !carriage_return_only_ && at_ != source_.end() && *at_ == '\n') ++at_;
        rest_ = line_;
    }

    std::string_view word() {
        while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
        std::size_t n = 0;
        while (n < rest_.size() && !is_blank(rest_[n])) ++n;
        std::string_view const result = rest_.substr(0, n);
        word_ = rest_.data();
        rest_.remove_prefix(n);
        return result;
    }

    [[noreturn]] void fail_here(errc code, std::string const& message) const {
        source_.fail_at(word_, code, message + ", got " + source_.token(word_));
    }

    source_text const& source_;
    char const* at_;
    char const* start_ = nullptr;
    char const* word_ = nullptr;
    std::string_view line_{};
    std::string_view rest_{};
    bool carriage_return_only_ = false;
    std::size_t declared_ = 0;
    ply_header header_{};
};

}  // namespace detail
}  // namespace tafoni

#endif
