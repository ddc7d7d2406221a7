/// \file
/// Reads STL, binary and ASCII; equal corners are welded into shared vertices.
#ifndef TAFONI_IO_READ_STL_HPP
#define TAFONI_IO_READ_STL_HPP

#include <tafoni/core/index.hpp>
#include <tafoni/io/detail/exact_welder.hpp>
#include <tafoni/io/detail/load_file.hpp>
#include <tafoni/io/detail/load_little.hpp>
#include <tafoni/io/detail/parse_number.hpp>
#include <tafoni/io/detail/source_text.hpp>
#include <tafoni/io/mesh_file.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace tafoni {
namespace detail {

/// True where the size of the file is the one that the count of a binary STL asks for.
[[nodiscard]] inline bool is_binary_stl(std::string_view bytes) noexcept {
    return bytes.size() >= 84 &&
           bytes.size() == 84 + std::uint64_t{50} * load_little<std::uint32_t>(bytes.data() + 80);
}

/// The origin that `write_stl` records in the header; zero where there is none.
[[nodiscard]] inline vec3 stl_origin(char const* header) noexcept {
    std::string_view text(header, 80);
    constexpr std::string_view magic = "tafoni origin ";
    if (text.substr(0, magic.size()) != magic) return vec3{0, 0, 0};
    char const* at = header + magic.size();
    vec3 origin{0, 0, 0};
    for (int axis = 0; axis < 3; ++axis) {
        while (at != header + 80 && *at == ' ') ++at;
        parsed_number const r = parse_float(at, header + 80);
        if (r.state != number_state::ok || !std::isfinite(r.value)) return vec3{0, 0, 0};
        origin[axis] = r.value;
        at = r.next;
    }
    return origin;
}

[[nodiscard]] inline mesh_file read_binary_stl(source_text const& source) {
    if (source.bytes.size() < 84) {
        source.fail_at_byte(source.end(), errc::truncated,
                            "expected 84 bytes of header, got " + std::to_string(source.bytes.size()));
    }
    char const* at = source.begin() + 80;
    std::uint32_t const count = load_little<std::uint32_t>(at);
    if (!is_binary_stl(source.bytes)) {
        std::uint64_t const wanted = 84 + std::uint64_t{50} * count;
        source.fail_at_byte(at, wanted > source.bytes.size() ? errc::truncated : errc::bad_count,
                            "expected " + std::to_string(wanted) + " bytes for " + std::to_string(count) +
                                " triangles, got " + std::to_string(source.bytes.size()));
    }
    at += 4;
    mesh_file out;
    out.origin = stl_origin(source.begin());
    out.mesh.offsets.reserve(std::size_t{count} + 1);
    out.mesh.corners.reserve(std::size_t{3} * count);
    exact_welder weld(out.mesh.positions);
    weld.reserve(count / 2 + 2);  // a closed surface has half as many vertices as triangles
    mesh_channel attribute{"attribute", {}, channel_type::uint16};
    for (std::uint32_t t = 0; t < count; ++t, at += 50) {
        for (std::size_t k = 0; k < 3; ++k) {
            char const* const place = at + 12 + 12 * k;
            vec3 p;
            for (int axis = 0; axis < 3; ++axis) {
                p[axis] = static_cast<double>(std::bit_cast<float>(load_little<std::uint32_t>(place + 4 * axis)));
                // Adding zero would turn -0.0 into 0.0, and the file would not come back as it was.
                if (out.origin[axis] != 0) p[axis] += out.origin[axis];
            }
            if (!is_finite(p)) {
                source.fail_at_byte(place, errc::non_finite_vertex,
                                    "expected finite coordinates of corner " + std::to_string(k) + " of triangle " +
                                        std::to_string(t),
                                    {.kind = entity::face, .index = t});
            }
            out.mesh.corners.push_back(weld.index_of(p));
        }
        out.mesh.offsets.push_back(out.mesh.corners.size());
        std::uint16_t const bits = load_little<std::uint16_t>(at + 48);
        if (bits != 0 && attribute.values.empty()) {
            attribute.values.reserve(count);
            attribute.values.resize(t, 0.0);
        }
        if (bits != 0 || !attribute.values.empty()) attribute.values.push_back(bits);
    }
    if (!attribute.values.empty()) out.attributes.face_channels.push_back(std::move(attribute));
    require_indexable(source.who, out.mesh.positions.size());
    return out;
}

/// ASCII STL: words, of which only the numbers behind `vertex` matter.
class text_stl_parser {
public:
    explicit text_stl_parser(source_text const& source)
        : source_(source), at_(source.require_text()), end_(source.end()) {}

    mesh_file parse() {
        skip_spaces();
        do {
            solid();
            skip_spaces();
        } while (at_ != end_);
        return std::move(out_);
    }

private:
    void solid() {
        expect("solid");
        while (at_ != end_ && is_blank(*at_)) ++at_;
        char const* const name = at_;
        while (at_ != end_ && !is_line_end(*at_)) ++at_;
        char const* stop = at_;
        while (stop != name && is_blank(stop[-1])) --stop;
        face_group group{std::string(name, stop), out_.mesh.face_count()};
        while (!accept("endsolid")) {
            expect("facet");
            facet();
        }
        while (at_ != end_ && !is_line_end(*at_)) ++at_;
        if (out_.mesh.face_count() > group.first_face) out_.attributes.groups.push_back(std::move(group));
    }

    void facet() {
        expect("normal");
        // The normal is told by the corners; scanners write NaN for slivers.
        for (int axis = 0; axis < 3; ++axis) static_cast<void>(number());
        expect("outer");
        expect("loop");
        for (std::size_t k = 0; k < 3; ++k) {
            expect("vertex");
            vec3 p;
            for (int axis = 0; axis < 3; ++axis) {
                p[axis] = number();
                if (!std::isfinite(p[axis])) {
                    source_.fail_at(number_, errc::non_finite_vertex,
                                    "expected a finite coordinate, got " + source_.token(number_),
                                    {.kind = entity::face, .index = out_.mesh.face_count(), .value = p[axis]});
                }
            }
            out_.mesh.corners.push_back(weld_.index_of(p));
        }
        out_.mesh.offsets.push_back(out_.mesh.corners.size());
        expect("endloop");
        expect("endfacet");
    }

    double number() {
        skip_spaces();
        number_ = at_;
        parsed_number const r = parse_double(at_, end_);
        if (r.state != number_state::ok || (r.next != end_ && !is_space(*r.next))) {
            source_.fail_at(at_, errc::bad_number, "expected a number, got " + source_.token(at_));
        }
        at_ = r.next;
        return r.value;
    }

    bool accept(std::string_view word) {
        skip_spaces();
        if (static_cast<std::size_t>(end_ - at_) < word.size()) return false;
        for (std::size_t k = 0; k < word.size(); ++k) {
            char const c = at_[k] >= 'A' && at_[k] <= 'Z' ? static_cast<char>(at_[k] + ('a' - 'A')) : at_[k];
            if (c != word[k]) return false;
        }
        char const* const next = at_ + word.size();
        if (next != end_ && !is_space(*next)) return false;
        at_ = next;
        return true;
    }
    void expect(std::string_view word) {
        if (accept(word)) return;
        source_.fail_at(at_, at_ == end_ ? errc::truncated : errc::bad_syntax,
                        "expected '" + std::string(word) + "', got " + source_.token(at_));
    }
    void skip_spaces() {
        while (at_ != end_ && is_space(*at_)) ++at_;
    }

    source_text const& source_;
    char const* at_;
    char const* end_;
    char const* number_ = nullptr;
    mesh_file out_{};
    exact_welder weld_{out_.mesh.positions};
};

}  // namespace detail

/// Reads an STL from memory; `name` stands in for the path in errors. O(bytes) expected.
///
/// Binary is told by the size that its count asks for, not by the word solid; else what starts
/// with solid and has no NUL byte in its first 512 is ASCII. Corners that are equal (-0.0 == 0.0)
/// become one vertex; triangles that collapse are kept. Normals are ignored, also NaN; attribute
/// bytes, where any is set, become the face channel "attribute"; the solids of an ASCII file are groups.
/// \throws io_error  naming line or byte: `truncated`, `bad_count`, `bad_syntax`, `bad_number`,
///                   `non_finite_vertex`, `wrong_format`, `empty_input`.
[[nodiscard]] inline mesh_file read_stl(std::string_view bytes, std::string_view name) {
    detail::source_text const source{"read_stl", bytes, name};
    if (!detail::is_binary_stl(bytes)) {
        char const* at = source.require_text();
        while (at != source.end() && detail::is_space(*at)) ++at;
        std::string_view const start(at, std::min<std::size_t>(5, static_cast<std::size_t>(source.end() - at)));
        bool const says_solid = start == "solid" || start == "SOLID" || start == "Solid";
        if (says_solid && bytes.substr(0, 512).find('\0') == std::string_view::npos) {
            return detail::text_stl_parser(source).parse();
        }
    }
    return detail::read_binary_stl(source);
}

/// Reads an STL file. \throws io_error  as above, and `cannot_open`, `not_a_file`.
[[nodiscard]] inline mesh_file read_stl(std::filesystem::path const& path) {
    detail::loaded_file const file = detail::load_file("read_stl", path);
    return read_stl(file.bytes(), path.string());
}

}  // namespace tafoni

#endif
