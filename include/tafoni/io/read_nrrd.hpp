/// \file
/// Reads volumes of samples in NRRD files.
#ifndef TAFONI_IO_READ_NRRD_HPP
#define TAFONI_IO_READ_NRRD_HPP

#include <tafoni/io/detail/load_file.hpp>
#include <tafoni/io/detail/load_little.hpp>
#include <tafoni/io/detail/parse_number.hpp>
#include <tafoni/io/detail/source_text.hpp>
#include <tafoni/voxel/sample_volume.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tafoni {
namespace detail {

class nrrd_parser {
public:
    explicit nrrd_parser(source_text const& source) : source_(source), at_(source.begin()), end_(source.end()) {
        source.require_plain();
    }

    sample_volume parse() {
        header();
        describe();
        samples();
        return std::move(out_);
    }

private:
    enum field : std::size_t {
        type, dimension, sizes, encoding, endian, spacings, directions, origin, data_file, byte_skip, line_skip, fields
    };
    /// Ways to write a name; what is not here says nothing about samples or places.
    struct name_of_field { std::string_view text; field which; };
    static constexpr std::array<name_of_field, 14> names{{
        {"type", type}, {"dimension", dimension}, {"sizes", sizes}, {"encoding", encoding}, {"endian", endian},
        {"spacings", spacings}, {"space directions", directions}, {"space origin", origin}, {"data file", data_file},
        {"datafile", data_file}, {"byte skip", byte_skip}, {"byteskip", byte_skip}, {"line skip", line_skip},
        {"lineskip", line_skip}}};
    enum class sample : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
    struct name_of_sample { std::string_view text; sample which; };
    static constexpr std::array<name_of_sample, 26> types{{
        {"signed char", sample::int8}, {"int8", sample::int8}, {"int8_t", sample::int8},
        {"uchar", sample::uint8}, {"unsigned char", sample::uint8}, {"uint8", sample::uint8}, {"uint8_t", sample::uint8},
        {"short", sample::int16}, {"short int", sample::int16}, {"signed short", sample::int16},
        {"signed short int", sample::int16}, {"int16", sample::int16}, {"int16_t", sample::int16},
        {"ushort", sample::uint16}, {"unsigned short", sample::uint16}, {"uint16", sample::uint16}, {"uint16_t", sample::uint16},
        {"int", sample::int32}, {"int32", sample::int32}, {"int32_t", sample::int32},
        {"uint", sample::uint32}, {"unsigned int", sample::uint32}, {"uint32", sample::uint32}, {"uint32_t", sample::uint32},
        {"float", sample::float32}, {"double", sample::float64}}};

    /// The value of a field, without the blanks around it.
    struct value {
        char const* begin = nullptr;
        char const* end = nullptr;
        [[nodiscard]] std::string_view text() const noexcept { return {begin, static_cast<std::size_t>(end - begin)}; }
    };

    /// A line without its end; `at_` moves behind that.
    value line() {
        char const* const start = at_;
        while (at_ != end_ && *at_ != '\n') ++at_;
        if (at_ == end_) source_.fail_at(at_, errc::truncated, "expected a line of the header, got end of file");
        char const* stop = at_++;
        if (stop != start && stop[-1] == '\r') --stop;
        return {start, stop};
    }

    void header() {
        std::string_view const magic = source_.bytes.substr(0, 4);
        if (magic != std::string_view("NRRD").substr(0, magic.size())) {
            source_.fail_at(at_, errc::wrong_format, "expected NRRD, got " + source_.token(at_));
        }
        value const first = line();
        std::string_view const version = first.text();
        if (version.size() != 8 || version.substr(4, 3) != "000" || version[7] < '1' || version[7] > '5') {
            source_.fail_at(first.begin, errc::unsupported, "expected NRRD0001 to NRRD0005, got " + source_.token(first.begin));
        }
        for (value l = line(); l.begin != l.end; l = line()) {
            if (*l.begin == '#') continue;
            char const* colon = std::find(l.begin, l.end, ':');
            if (colon == l.end) source_.fail_at(l.begin, errc::bad_syntax, "expected 'field: value', got " + source_.token(l.begin));
            if (colon + 1 != l.end && colon[1] == '=') continue;  // a key and value of the user's own
            std::string key;
            for (char const* c = l.begin; c != colon && key.size() < 32; ++c) {
                key += *c >= 'A' && *c <= 'Z' ? static_cast<char>(*c + ('a' - 'A')) : *c;
            }
            auto const known = std::find_if(names.begin(), names.end(), [&](auto const& n) { return n.text == key; });
            if (known == names.end()) continue;
            if (field_[known->which].begin != nullptr) source_.fail_at(l.begin, errc::bad_syntax, key + " is given twice");
            value v{colon + 1, l.end};
            while (v.begin != v.end && is_blank(*v.begin)) ++v.begin;
            while (v.end != v.begin && is_blank(v.end[-1])) --v.end;
            field_[known->which] = v;
        }
    }

    value const& required(field f, char const* name) const {
        if (field_[f].begin == nullptr) source_.fail_at(at_, errc::bad_syntax, std::string("expected the field ") + name + " in the header");
        return field_[f];
    }
    [[nodiscard]] bool has(field f) const noexcept { return field_[f].begin != nullptr; }

    /// `count` numbers; brackets and commas, which make vectors of them, are passed over.
    std::vector<double> numbers(value const& v, std::size_t count) const {
        std::vector<double> r;
        for (char const* at = v.begin;;) {
            while (at != v.end && (is_blank(*at) || *at == '(' || *at == ')' || *at == ',')) ++at;
            if (at == v.end) break;
            if (r.size() == count) source_.fail_at(at, errc::bad_count, "expected " + std::to_string(count) + " numbers, got more");
            parsed_number const n = parse_double(at, v.end);
            bool const complete = n.state == number_state::ok && std::isfinite(n.value) &&
                                  (n.next == v.end || is_blank(*n.next) || *n.next == ')' || *n.next == ',');
            if (!complete) source_.fail_at(at, errc::bad_number, "expected a number, got " + source_.token(at));
            r.push_back(n.value);
            at = n.next;
        }
        if (r.size() != count) {
            source_.fail_at(v.begin, errc::bad_count, "expected " + std::to_string(count) + " numbers, got " + std::to_string(r.size()));
        }
        return r;
    }

    std::uint64_t whole(char const*& at, char const* end) const {
        while (at != end && is_blank(*at)) ++at;
        parsed_integer const n = at == end ? parsed_integer{} : parse_integer(at, end);
        bool const complete = at != end && n.state == number_state::ok && !n.negative && (n.next == end || is_blank(*n.next));
        if (!complete) source_.fail_at(at, errc::bad_number, "expected a whole number, got " + source_.token(at));
        at = n.next;
        return n.magnitude;
    }
    void only(value const& v, char const* at) const {
        if (at != v.end) source_.fail_at(at, errc::bad_count, "expected the end of the line, got " + source_.token(at));
    }

    void describe() {
        if (has(data_file)) {
            source_.fail_at(field_[data_file].begin, errc::unsupported, "the samples are in another file; attach them first");
        }
        for (field const f : {byte_skip, line_skip}) {
            if (has(f) && field_[f].text() != "0") {
                source_.fail_at(field_[f].begin, errc::unsupported, "expected samples right behind the header");
            }
        }
        value const& coded = required(encoding, "encoding");
        if (coded.text() != "raw") {
            source_.fail_at(coded.begin, errc::unsupported, "expected the encoding raw, got " + source_.token(coded.begin));
        }
        value const& named = required(type, "type");
        auto const found = std::find_if(types.begin(), types.end(), [&](auto const& t) { return t.text == named.text(); });
        if (found == types.end()) {
            source_.fail_at(named.begin, errc::unsupported,
                            "expected a type of 8, 16 or 32 bits, float or double, got " + source_.token(named.begin));
        }
        sample_ = found->which;
        width_ = sample_ <= sample::uint8 ? 1 : sample_ <= sample::uint16 ? 2 : sample_ <= sample::float32 ? 4 : 8;
        if (width_ > 1) {
            value const& order = required(endian, "endian");
            big_ = order.text() == "big";
            if (!big_ && order.text() != "little") {
                source_.fail_at(order.begin, errc::bad_syntax, "expected little or big, got " + source_.token(order.begin));
            }
        }
        value const& dims = required(dimension, "dimension");
        if (dims.text() != "3") source_.fail_at(dims.begin, errc::unsupported, "expected 3 dimensions, got " + source_.token(dims.begin));
        value const& size = required(sizes, "sizes");
        char const* at = size.begin;
        for (std::size_t d = 0; d < 3; ++d) {
            char const* const place = at;
            std::uint64_t const n = whole(at, size.end);
            if (n == 0 || n > grid_frame::longest) {
                source_.fail_at(place, errc::bad_count, "expected a size of 1 to 1048576, got " + std::to_string(n));
            }
            out_.frame.size[d] = n;
        }
        only(size, at);
        place();
    }

    void place() {
        if (has(spacings) && has(directions)) {
            source_.fail_at(field_[directions].begin, errc::bad_syntax, "expected spacings or space directions, got both");
        }
        if (has(spacings)) {
            std::vector<double> const s = numbers(field_[spacings], 3);
            for (std::size_t d = 0; d < 3; ++d) spacing(spacings, d, s[d]);
        }
        if (has(directions)) {
            std::vector<double> const s = numbers(field_[directions], 9);
            for (std::size_t d = 0; d < 3; ++d) {
                for (std::size_t c = 0; c < 3; ++c) {
                    if (c != d && s[3 * d + c] != 0) {
                        source_.fail_at(field_[directions].begin, errc::unsupported, "expected axes along x, y and z; resample first");
                    }
                }
                backwards_[d] = s[4 * d] < 0;
                spacing(directions, d, std::fabs(s[4 * d]));
            }
        }
        out_.placed = has(origin);
        if (!out_.placed) return;
        // The origin of the file is the place of its first sample, ours the lower corner of the lowest voxel.
        std::vector<double> const o = numbers(field_[origin], 3);
        for (std::size_t d = 0; d < 3; ++d) {
            auto const a = static_cast<Eigen::Index>(d);
            double const before = backwards_[d] ? static_cast<double>(out_.frame.size[d]) - 0.5 : 0.5;
            out_.frame.origin[a] = o[d] - before * out_.frame.spacing[a];
            if (!(std::fabs(out_.frame.origin[a]) < 1e150)) {
                source_.fail_at(field_[origin].begin, errc::out_of_range, "expected an origin within 1e150");
            }
        }
    }
    void spacing(field f, std::size_t d, double s) {
        if (!(s >= 1e-100 && s <= 1e100)) {
            source_.fail_at(field_[f].begin, errc::out_of_range, "expected a spacing within 1e-100 and 1e100, got " + number_text(s));
        }
        out_.frame.spacing[static_cast<Eigen::Index>(d)] = s;
    }

    template <class Bits>
    [[nodiscard]] Bits bits(char const* at) const noexcept {
        Bits const little = load_little<Bits>(at);
        if (!big_) return little;
        Bits swapped = 0;
        for (std::size_t k = 0; k < sizeof(Bits); ++k) {
            swapped = static_cast<Bits>(swapped | static_cast<Bits>(static_cast<Bits>(little >> (8 * k) & 0xff) << (8 * (sizeof(Bits) - 1 - k))));
        }
        return swapped;
    }
    [[nodiscard]] float sample_at(char const* at) const noexcept {
        switch (sample_) {
            case sample::int8: return static_cast<float>(static_cast<std::int8_t>(*at));
            case sample::uint8: return static_cast<float>(static_cast<std::uint8_t>(*at));
            case sample::int16: return static_cast<float>(static_cast<std::int16_t>(bits<std::uint16_t>(at)));
            case sample::uint16: return static_cast<float>(bits<std::uint16_t>(at));
            case sample::int32: return static_cast<float>(static_cast<std::int32_t>(bits<std::uint32_t>(at)));
            case sample::uint32: return static_cast<float>(bits<std::uint32_t>(at));
            case sample::float32: return std::bit_cast<float>(bits<std::uint32_t>(at));
            case sample::float64: break;
        }
        return static_cast<float>(std::bit_cast<double>(bits<std::uint64_t>(at)));
    }

    void samples() {
        std::array<std::size_t, 3> const& n = out_.frame.size;
        std::uint64_t const count = std::uint64_t{n[0]} * n[1] * n[2];  // at most 2^60
        auto const left = static_cast<std::uint64_t>(end_ - at_);
        if (left / width_ < count || left != count * width_) {
            source_.fail_at_byte(at_, left / width_ < count ? errc::truncated : errc::bad_count,
                                 "expected " + std::to_string(count) + " samples of " + std::to_string(width_) +
                                     " bytes, got " + std::to_string(left) + " bytes");
        }
        out_.samples.resize(count);
        for (std::size_t k = 0; k < n[2]; ++k) {
            std::size_t const z = backwards_[2] ? n[2] - 1 - k : k;
            for (std::size_t j = 0; j < n[1]; ++j) {
                std::size_t const y = backwards_[1] ? n[1] - 1 - j : j;
                float* const row = out_.samples.data() + n[0] * (y + n[1] * z);
                for (std::size_t i = 0; i < n[0]; ++i, at_ += width_) row[backwards_[0] ? n[0] - 1 - i : i] = sample_at(at_);
            }
        }
    }

    source_text const& source_;
    char const* at_;
    char const* end_;
    std::array<value, fields> field_{};
    sample sample_ = sample::uint8;
    std::size_t width_ = 1;
    bool big_ = false;
    std::array<bool, 3> backwards_{};
    sample_volume out_{};
};

}  // namespace detail

/// Reads a NRRD volume from memory; `name` stands in for the path in errors. O(bytes).
///
/// Three dimensions, encoding raw behind the header, integers of 8 to 32 bits, float and double of either byte
/// order; each sample rounded to float once, NaN and infinities carried. Spacings or space directions along the
/// axes (an axis that runs backwards is turned round), space origin (the place of the first sample); without
/// them cubes of edge 1 from the lower corner (0, 0, 0). Other fields, keys and comments are passed over.
/// \throws io_error  naming line and column, or the byte: `wrong_format`, `unsupported` (compressed or text
///                   samples, samples in another file, other dimensions, oblique axes), `bad_syntax`,
///                   `bad_number`, `bad_count`, `out_of_range`, `truncated`, `empty_input`.
[[nodiscard]] inline sample_volume read_nrrd(std::string_view bytes, std::string_view name) {
    detail::source_text const source{"read_nrrd", bytes, name};
    return detail::nrrd_parser(source).parse();
}

/// Reads a NRRD file. \throws io_error  as above, and `cannot_open`, `not_a_file`.
[[nodiscard]] inline sample_volume read_nrrd(std::filesystem::path const& path) {
    detail::loaded_file const file = detail::load_file("read_nrrd", path);
    return read_nrrd(file.bytes(), path.string());
}

}  // namespace tafoni

#endif
