/// \file
/// Reads Wavefront OBJ: polygons with texture coordinates, normals, groups and vertex colours.
#ifndef TAFONI_IO_READ_OBJ_HPP
#define TAFONI_IO_READ_OBJ_HPP

#include <tafoni/io/detail/load_file.hpp>
#include <tafoni/io/detail/parse_number.hpp>
#include <tafoni/io/detail/source_text.hpp>
#include <tafoni/io/mesh_file.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace tafoni {
namespace detail {

/// One pass over an OBJ. `limits` are the numbers of v, vt and vn; unknown (maximal) in the first pass.
class obj_parser {
public:
    static constexpr std::uint64_t unknown = std::numeric_limits<std::uint64_t>::max();

    obj_parser(source_text const& source, std::array<std::uint64_t, 3> limits)
        : source_(source), at_(source.require_text()), end_(source.end()), limits_(limits) {}

    mesh_file parse() {
        reserve();
        while (at_ != end_) statement();
        finish();
        return std::move(out_);
    }

    /// Numbers of v, vt, vn, and the largest index used of each plus one.
    [[nodiscard]] std::array<std::uint64_t, 3> counts() const {
        return {position_count_, texture_count_, normal_count_};
    }
    [[nodiscard]] bool indices_exceed(std::array<std::uint64_t, 3> const& counts) const {
        return highest_[0] > counts[0] || highest_[1] > counts[1] || highest_[2] > counts[2];
    }

private:
    /// Room for what lines that end with LF declare; another file grows as it is read.
    void reserve() {
        std::size_t vertices = 0;
        std::size_t faces = 0;
        for (char const* line = at_; end_ - line > 2;) {
            if (line[1] == ' ') {
                vertices += line[0] == 'v' ? 1 : 0;
                faces += line[0] == 'f' ? 1 : 0;
            }
            auto const* const stop = static_cast<char const*>(std::memchr(line, '\n', static_cast<std::size_t>(end_ - line)));
            if (stop == nullptr) break;
            line = stop + 1;
        }
        out_.mesh.positions.reserve(vertices);
        out_.mesh.offsets.reserve(faces + 1);
        out_.mesh.corners.reserve(3 * faces);
    }

    void statement() {
        skip_blanks();
        if (at_ == end_) return;
        char const c = *at_;
        if (is_line_end(c)) {
            ++at_;
            return;
        }
        bool const single = at_ + 1 == end_ || is_separator(at_[1]);
        if (c == '#') {
            while (at_ != end_ && !is_line_end(*at_)) ++at_;
        } else if (c == 'v' && single) {
            ++at_;
            vertex();
        } else if (c == 'f' && single) {
            ++at_;
            face();
        } else if (c == 'v' && is_keyword("vt")) {
            at_ += 2;
            texture();
        } else if (c == 'v' && is_keyword("vn")) {
            at_ += 2;
            normal();
        } else {
            other();
        }
    }

    void vertex() {
        std::array<double, 8> values;
        char const* const start = at_;
        std::size_t const n = numbers(values, "coordinate");
        if (n < 3 || n == 5 || n > 7) {
            source_.fail_at(start, errc::bad_syntax,
                            "expected 'v' with x y z, and optionally w or a colour (3, 4, 6 or 7 numbers), got " +
                                std::to_string(n));
        }
        out_.mesh.positions.push_back(vec3{values[0], values[1], values[2]});
        ++position_count_;
        if (n < 6 && colours_ == 0) return;
        std::size_t const wanted = n < 6 ? 0 : n - 3;
        while (colours_ < wanted) {
            static constexpr char const* names[] = {"red", "green", "blue", "alpha"};
            out_.attributes.vertex_channels.push_back({names[colours_++], {}, channel_type::float64});
        }
        for (std::size_t k = 0; k < colours_; ++k) {
            std::vector<double>& channel = out_.attributes.vertex_channels[k].values;
            // Four channels that double would, for a moment, be more than the file's share of memory.
            if (channel.capacity() < position_count_) channel.reserve(position_count_ + position_count_ / 2);
            if (channel.size() + 1 < position_count_) {
                channel.resize(position_count_ - 1, std::numeric_limits<double>::quiet_NaN());
            }
            channel.push_back(k < wanted ? values[3 + k] : std::numeric_limits<double>::quiet_NaN());
        }
    }

    void texture() {
        std::array<double, 8> values;
        char const* const start = at_;
        std::size_t const n = numbers(values, "texture coordinate");
        if (n < 1 || n > 3) {
            source_.fail_at(start, errc::bad_syntax, "expected 'vt' with 1 to 3 numbers, got " + std::to_string(n));
        }
        out_.attributes.texture.push_back({values[0], n > 1 ? values[1] : 0.0});
        ++texture_count_;
    }

    void normal() {
        std::array<double, 8> values;
        char const* const start = at_;
        std::size_t const n = numbers(values, "normal");
        if (n != 3) source_.fail_at(start, errc::bad_syntax, "expected 'vn' with 3 numbers, got " + std::to_string(n));
        out_.attributes.normals.push_back(vec3{values[0], values[1], values[2]});
        ++normal_count_;
    }

    /// The finite numbers up to the end of the statement; counts beyond what `values` holds.
    std::size_t numbers(std::array<double, 8>& values, char const* what) {
        std::size_t n = 0;
        for (skip_blanks(); !at_end(); skip_blanks()) {
            parsed_number const r = parse_double(at_, end_);
            bool const complete = r.state == number_state::ok && (r.next == end_ || is_separator(*r.next));
            if (!complete) {
                bool const large = r.state == number_state::overflow;
                source_.fail_at(at_, errc::bad_number,
                                std::string("expected a ") + what + (large ? " that fits a double, got " : ", got ") +
                                    source_.token(at_));
            }
            // !(<=) also catches NaN.
            if (!(r.value <= std::numeric_limits<double>::max() && r.value >= -std::numeric_limits<double>::max())) {
                source_.fail_at(at_, errc::non_finite_vertex,
                                std::string("expected a finite ") + what + ", got " + source_.token(at_),
                                {.kind = entity::vertex, .index = position_count_, .value = r.value});
            }
            if (n < values.size()) values[n] = r.value;
            ++n;
            at_ = r.next;
        }
        return n;
    }

    void face() {
        char const* const start = at_;
        std::vector<std::uint32_t>& corners = out_.mesh.corners;
        std::size_t const first = corners.size();
        mesh_attributes& extra = out_.attributes;
        for (skip_blanks(); !at_end(); skip_blanks()) {
            corners.push_back(index(0, position_count_));
            std::uint32_t texture = mesh_attributes::none;
            std::uint32_t normal = mesh_attributes::none;
            if (at_ != end_ && *at_ == '/') {
                ++at_;
                if (at_ != end_ && *at_ != '/' && !is_separator(*at_)) texture = index(1, texture_count_);
                if (at_ != end_ && *at_ == '/') {
                    ++at_;
                    if (at_ != end_ && !is_separator(*at_)) normal = index(2, normal_count_);
                }
            }
            if (at_ != end_ && !is_separator(*at_)) {
                source_.fail_at(at_, errc::bad_syntax, "expected a space or '/' behind an index, got " + source_.token(at_));
            }
            keep(extra.corner_texture, texture);
            keep(extra.corner_normals, normal);
        }
        std::size_t const size = corners.size() - first;
        if (size < 3) {
            source_.fail_at(start, errc::degenerate_face,
                            "expected a face of at least 3 corners, got " + std::to_string(size),
                            {.kind = entity::face, .index = out_.mesh.face_count(), .value = double(size), .limit = 3});
        }
        out_.mesh.offsets.push_back(corners.size());
    }

    /// Appends the corner's index; arrays that no corner uses stay empty.
    void keep(std::vector<std::uint32_t>& list, std::uint32_t value) {
        if (value == mesh_attributes::none && list.empty()) return;
        list.resize(out_.mesh.corners.size() - 1, mesh_attributes::none);
        list.push_back(value);
    }

    /// A one-based or negative index into `kind` (v, vt, vn), of which `count` are defined so far.
    std::uint32_t index(std::size_t kind, std::uint64_t count) {
        static constexpr char const* names[] = {"vertex", "texture", "normal"};
        parsed_integer const r = parse_integer(at_, end_);
        if (r.state == number_state::malformed) {
            source_.fail_at(at_, errc::bad_number, std::string("expected a ") + names[kind] + " index, got " + source_.token(at_));
        }
        std::uint64_t const limit = r.negative ? count : std::min(limits_[kind], std::uint64_t{mesh_attributes::none});
        if (r.state == number_state::overflow || r.magnitude == 0 || r.magnitude > limit) {
            std::string const bound = r.magnitude == 0 && r.state == number_state::ok ? "is zero, indices start at 1"
                                      : limit == mesh_attributes::none ? "exceeds 32 bits"
                                      : "exceeds the " + std::to_string(limit) + " defined";
            double const value = static_cast<double>(r.magnitude);
            source_.fail_at(at_, errc::index_out_of_range,
                            std::string(names[kind]) + " index " + source_.token(at_) + " of face " +
                                std::to_string(out_.mesh.face_count()) + " " + bound,
                            {.kind = entity::face, .index = out_.mesh.face_count(),
                             .value = r.negative ? -value : value, .limit = static_cast<double>(limit)});
        }
        at_ = r.next;
        std::uint64_t const one_based = r.negative ? count + 1 - r.magnitude : r.magnitude;
        highest_[kind] = std::max(highest_[kind], one_based);
        return static_cast<std::uint32_t>(one_based - 1);
    }

    void other() {
        static constexpr std::string_view ignored[] = {
            "l", "p", "s", "mg", "vp", "usemap", "maplib", "bevel", "c_interp", "d_interp", "lod", "shadow_obj",
            "trace_obj", "ctech", "stech", "cstype", "deg", "bmat", "step", "parm", "trim", "hole", "scrv", "sp",
            "end", "con", "call", "csh"};
        char const* const start = at_;
        while (at_ != end_ && !is_separator(*at_)) ++at_;
        std::string_view const keyword(start, static_cast<std::size_t>(at_ - start));
        if (keyword == "g") {
            group(out_.attributes.groups);
        } else if (keyword == "o") {
            group(out_.attributes.objects);
        } else if (keyword == "usemtl") {
            group(out_.attributes.materials);
        } else if (keyword == "mtllib") {
            std::string name = rest_of_line();
            if (out_.attributes.material_libraries.size() < 64) {
                out_.attributes.material_libraries.push_back(std::move(name));
            }
        } else if (keyword == "surf" || keyword == "curv" || keyword == "curv2") {
            source_.fail_at(start, errc::unsupported, "free-form curves and surfaces are not read; export polygons");
        } else if (std::find(std::begin(ignored), std::end(ignored), keyword) != std::end(ignored)) {
            for (skip_blanks(); at_ != end_ && !is_line_end(*at_); skip_blanks()) ++at_;
        } else {
            source_.fail_at(start, errc::bad_syntax,
                            "expected an OBJ statement (v, vt, vn, f, g, o, ...), got " + source_.token(start));
        }
    }

    /// Opens a group at the next face; one that gets no face is replaced by the next.
    void group(std::vector<face_group>& list) {
        std::string name = rest_of_line();
        std::size_t const face = out_.mesh.face_count();
        if (!list.empty() && list.back().first_face == face) {
            list.back().name = std::move(name);
        } else {
            list.push_back({std::move(name), face});
        }
    }

    std::string rest_of_line() {
        while (at_ != end_ && is_blank(*at_)) ++at_;
        char const* const start = at_;
        while (at_ != end_ && !is_line_end(*at_)) ++at_;
        char const* stop = at_;
        while (stop != start && is_blank(stop[-1])) --stop;
        return std::string(start, stop);
    }

    void finish() {
        require_indexable(source_.who, position_count_);
        mesh_attributes& a = out_.attributes;
        if (!a.corner_texture.empty()) a.corner_texture.resize(out_.mesh.corners.size(), mesh_attributes::none);
        if (!a.corner_normals.empty()) a.corner_normals.resize(out_.mesh.corners.size(), mesh_attributes::none);
        for (std::vector<face_group>* list : {&a.objects, &a.groups, &a.materials}) {
            if (!list->empty() && list->back().first_face == out_.mesh.face_count()) list->pop_back();
        }
    }

    [[nodiscard]] bool is_keyword(std::string_view word) const {
        std::size_t const left = static_cast<std::size_t>(end_ - at_);
        return left >= word.size() && std::string_view(at_, word.size()) == word &&
               (left == word.size() || is_separator(at_[word.size()]));
    }
    [[nodiscard]] static bool is_separator(char c) noexcept { return is_space(c) || c == '\\' || c == '#'; }
    [[nodiscard]] bool at_end() const noexcept { return at_ == end_ || is_line_end(*at_) || *at_ == '#'; }

    /// Skips blanks and backslashes that continue a statement on the next line.
    void skip_blanks() noexcept {
        for (;;) {
            while (at_ != end_ && is_blank(*at_)) ++at_;
            if (at_ == end_ || *at_ != '\\') return;
            char const* next = at_ + 1;
            if (next != end_ && !is_line_end(*next)) return;
            if (next != end_ && *next++ == '\r' && next != end_ && *next == '\n') ++next;
            at_ = next;
        }
    }

    source_text const& source_;
    char const* at_;
    char const* end_;
    std::array<std::uint64_t, 3> limits_;
    std::array<std::uint64_t, 3> highest_{0, 0, 0};
    std::uint64_t position_count_ = 0;
    std::uint64_t texture_count_ = 0;
    std::uint64_t normal_count_ = 0;
    std::size_t colours_ = 0;
    mesh_file out_{};
};

}  // namespace detail

/// Reads an OBJ from memory; `name` stands in for the path in errors. O(bytes).
///
/// Any line ending, `\` continuation, negative and forward indices, polygons of any size. A face
/// needs three corners; a fourth coordinate w and a third texture coordinate are checked and
/// dropped; vertex colours become the channels red, green, blue (alpha), NaN where a vertex has
/// none. Lines, points and smoothing groups are skipped; files that are referenced are never
/// opened. Numbers are decimal: hex, a suffix, nan, inf and 1e999 are errors, 1e-999 is zero.
/// \throws io_error  naming line and column: `bad_syntax`, `bad_number`, `non_finite_vertex`,
///                   `index_out_of_range`, `degenerate_face`, `unsupported`, `wrong_format`, `empty_input`.
[[nodiscard]] inline mesh_file read_obj(std::string_view bytes, std::string_view name) {
    detail::source_text const source{"read_obj", bytes, name};
    constexpr std::uint64_t unknown = detail::obj_parser::unknown;
    std::array<std::uint64_t, 3> counts{};
    {
        detail::obj_parser parser(source, {unknown, unknown, unknown});
        mesh_file result = parser.parse();
        counts = parser.counts();
        if (!parser.indices_exceed(counts)) return result;
    }
    // Indices may refer forward, so only now is it known that one leads nowhere; this pass finds its line.
    return detail::obj_parser(source, counts).parse();
}

/// Reads an OBJ file. \throws io_error  as above, and `cannot_open`, `not_a_file`.
[[nodiscard]] inline mesh_file read_obj(std::filesystem::path const& path) {
    detail::loaded_file const file = detail::load_file("read_obj", path);
    return read_obj(file.bytes(), path.string());
}

}  // namespace tafoni

#endif
