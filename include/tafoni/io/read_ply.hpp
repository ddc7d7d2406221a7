/// \file
/// Reads PLY: ASCII and both binary byte orders, with every scalar property kept as a channel.
#ifndef TAFONI_IO_READ_PLY_HPP
#define TAFONI_IO_READ_PLY_HPP

#include <tafoni/io/detail/load_file.hpp>
#include <tafoni/io/detail/ply_header.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tafoni {
namespace detail {

/// Reads the body behind a `ply_header`; one instance per encoding, so that numbers cost no branch on it.
template <ply_encoding Encoding>
class ply_body_parser {
public:
    ply_body_parser(source_text const& source, ply_header const& header)
        : source_(source), header_(header), at_(header.body), end_(source.end()) {}

    mesh_file parse() {
        ply_element const* vertices = nullptr;
        for (ply_element const& e : header_.elements) {
            if (e.name == "vertex") vertices = &e;
        }
        if (vertices == nullptr) {
            source_.fail_at(source_.begin(), errc::missing_property, "expected an element 'vertex', got none");
        }
        vertex_count_ = vertices->count;
        for (ply_element const& e : header_.elements) {
            if (e.name == "vertex") {
                read_vertices(e);
            } else if (e.name == "face") {
                read_faces(e);
            } else if (e.name == "tristrips" && e.count != 0) {
                source_.fail_at(e.place, errc::unsupported, "triangle strips are not read; export faces");
            } else {
                skip_element(e);
            }
        }
        if (ascii) {
            while (at_ != end_ && is_space(*at_)) ++at_;
        }
        if (at_ != end_) fail_here(errc::bad_count, "expected the end of the file behind the last element, got more");
        shift_to_origin();
        return std::move(out_);
    }

private:
    static constexpr bool ascii = Encoding == ply_encoding::ascii;
    static constexpr std::uint32_t skipped = 0xffffffffU;
    static constexpr std::uint32_t indices = 0xfffffffeU;

    /// What becomes of each property: 0..2 a coordinate, 3.. a channel, `indices`, or `skipped`.
    using roles = std::vector<std::uint32_t>;

    void read_vertices(ply_element const& e) {
        roles role;
        bool has[3] = {false, false, false};
        for (ply_property const& p : e.properties) {
            std::uint32_t const axis = p.name == "x" ? 0 : p.name == "y" ? 1 : p.name == "z" ? 2 : 3;
            if (axis < 3 && p.is_list) source_.fail_at(e.place, errc::bad_syntax, "property " + p.name + " is a list");
            if (axis < 3) has[axis] = true;
            role.push_back(axis < 3 ? axis : skipped);
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (e.count != 0 && !has[axis]) {
                source_.fail_at(e.place, errc::missing_property,
                                std::string("expected a vertex property ") + "xyz"[axis] + ", got none");
            }
        }
        require_room(e, minimal_record(e));
        require_indexable(source_.who, e.count);
        open_channels(e, role, out_.attributes.vertex_channels);
        out_.mesh.positions.reserve(e.count);
        for (std::uint64_t i = 0; i < e.count; ++i) {
            begin_record();
            vec3 position{0, 0, 0};
            for (std::size_t k = 0; k < role.size(); ++k) {
                ply_property const& p = e.properties[k];
                if (p.is_list) {
                    skip_list(p);
                    continue;
                }
                char const* const place = next_value();
                double const value = scalar(p.type);
                if (role[k] >= 3) {
                    out_.attributes.vertex_channels[role[k] - 3].values.push_back(value);
                    continue;
                }
                position[static_cast<int>(role[k])] = value;
                if (!std::isfinite(value)) {
                    at_ = place;
                    fail_here(errc::non_finite_vertex,
                              "expected a finite coordinate " + p.name + " of vertex " + std::to_string(i),
                              {.kind = entity::vertex, .index = i, .value = value});
                }
            }
            out_.mesh.positions.push_back(position);
            end_record();
        }
    }

    void read_faces(ply_element const& e) {
        roles role;
        bool has_corners = false;
        std::size_t record = minimal_record(e);
        for (ply_property const& p : e.properties) {
            bool const corners = p.name == "vertex_indices" || p.name == "vertex_index";
            if (corners && (!p.is_list || !is_integer(p.type) || has_corners)) {
                source_.fail_at(e.place, errc::bad_syntax, "expected one list of an integer type for " + p.name);
            }
            has_corners = has_corners || corners;
            // A face of less than three corners is an error, so every record holds at least three.
            if (corners) record += ascii ? 6 : 3 * size_of(p.type);
            role.push_back(corners ? indices : skipped);
        }
        if (e.count != 0 && !has_corners) {
            source_.fail_at(e.place, errc::missing_property, "expected a face property vertex_indices, got none");
        }
        require_room(e, record);
        require_indexable(source_.who, e.count);
        open_channels(e, role, out_.attributes.face_channels);
        out_.mesh.offsets.reserve(e.count + 1);
        out_.mesh.corners.reserve(3 * e.count);
        for (std::uint64_t i = 0; i < e.count; ++i) {
            begin_record();
            for (std::size_t k = 0; k < role.size(); ++k) {
                ply_property const& p = e.properties[k];
                if (role[k] == indices) {
                    read_corners(p, i);
                } else if (p.is_list) {
                    skip_list(p);
                } else {
                    double const value = scalar(p.type);
                    out_.attributes.face_channels[role[k] - 3].values.push_back(value);
                }
            }
            end_record();
        }
    }

    void read_corners(ply_property const& p, std::uint64_t face) {
        char const* const start = next_value();
        std::uint64_t const n = list_length(p);
        if (n < 3) {
            at_ = start;
            fail_here(errc::degenerate_face,
                      "expected at least 3 corners of face " + std::to_string(face) + ", got " + std::to_string(n),
                      {.kind = entity::face, .index = face, .value = static_cast<double>(n), .limit = 3});
        }
        for (std::uint64_t k = 0; k < n; ++k) {
            char const* const place = next_value();
            double const corner = scalar(p.type);
            if (!(corner >= 0 && corner < static_cast<double>(vertex_count_))) {
                at_ = place;
                fail_here(errc::index_out_of_range,
                          "corner " + std::to_string(k) + " of face " + std::to_string(face) + " is vertex " +
                              std::to_string(static_cast<std::int64_t>(corner)) + " of " + std::to_string(vertex_count_),
                          {.kind = entity::face, .index = face, .value = corner,
                           .limit = static_cast<double>(vertex_count_) - 1});
            }
            out_.mesh.corners.push_back(static_cast<std::uint32_t>(corner));
        }
        out_.mesh.offsets.push_back(out_.mesh.corners.size());
    }

    void skip_element(ply_element const& e) {
        if (e.properties.empty()) return;
        require_room(e, minimal_record(e));
        for (std::uint64_t i = 0; i < e.count; ++i) {
            begin_record();
            for (ply_property const& p : e.properties) {
                if (p.is_list) {
                    skip_list(p);
                } else {
                    static_cast<void>(scalar(p.type));
                }
            }
            end_record();
        }
    }

    void skip_list(ply_property const& p) {
        std::uint64_t const n = list_length(p);
        if constexpr (ascii) {
            for (std::uint64_t k = 0; k < n; ++k) static_cast<void>(scalar(p.type));
        } else {
            at_ += n * size_of(p.type);
        }
    }

    /// The length of a list, which the bytes that are left can hold.
    std::uint64_t list_length(ply_property const& p) {
        char const* const place = next_value();
        double const n = scalar(p.count_type);
        double const item = ascii ? 2 : static_cast<double>(size_of(p.type));
        if (!(n >= 0 && n * item <= static_cast<double>(end_ - at_) + 1)) {
            at_ = place;
            fail_here(n < 0 ? errc::bad_count : errc::truncated,
                      "expected a list that fits the file, got length " + std::to_string(static_cast<std::int64_t>(n)));
        }
        if (!ascii && n * item > static_cast<double>(end_ - at_)) fail_here(errc::truncated, "the file ends in a list");
        return static_cast<std::uint64_t>(n);
    }

    /// Least bytes that one record takes; in text, one digit and one separator per number.
    [[nodiscard]] static std::size_t minimal_record(ply_element const& e) {
        std::size_t bytes = 0;
        for (ply_property const& p : e.properties) bytes += ascii ? 2 : size_of(p.is_list ? p.count_type : p.type);
        return bytes;
    }

    /// Refuses a claimed count before anything is allocated for it.
    void require_room(ply_element const& e, std::size_t record) const {
        std::uint64_t const left = static_cast<std::uint64_t>(end_ - at_) + (ascii ? 1 : 0);
        if (record != 0 && e.count > left / record) {
            source_.fail_at(e.place, errc::bad_count,
                            "element " + e.name + " claims " + std::to_string(e.count) + " records of at least " +
                                std::to_string(record) + " bytes, but " + std::to_string(end_ - at_) + " bytes are left");
        }
    }

    /// Gives every scalar property without a role a channel of its own, with room for all values.
    static void open_channels(ply_element const& e, roles& role, std::vector<mesh_channel>& channels) {
        for (std::size_t k = 0; k < role.size(); ++k) {
            if (role[k] != skipped || e.properties[k].is_list) continue;
            role[k] = static_cast<std::uint32_t>(channels.size()) + 3;
            channels.push_back({e.properties[k].name, {}, e.properties[k].type});
            channels.back().values.reserve(e.count);
        }
    }

    double scalar(channel_type type) {
        if constexpr (ascii) {
            return text_scalar(type);
        } else {
            if (static_cast<std::size_t>(end_ - at_) < size_of(type)) fail_here(errc::truncated, "the file ends in a record");
            switch (type) {
                case channel_type::int8: return load<std::int8_t>();
                case channel_type::uint8: return load<std::uint8_t>();
                case channel_type::int16: return load<std::int16_t>();
                case channel_type::uint16: return load<std::uint16_t>();
                case channel_type::int32: return load<std::int32_t>();
                case channel_type::uint32: return load<std::uint32_t>();
                case channel_type::float32: return static_cast<double>(load<float>());
                case channel_type::float64: return load<double>();
            }
            return 0;
        }
    }

    template <class T>
    T load() {
        unsigned char bytes[sizeof(T)];
        std::memcpy(bytes, at_, sizeof(T));
        if constexpr ((Encoding == ply_encoding::big_endian) != (std::endian::native == std::endian::big)) {
            for (std::size_t k = 0; k < sizeof(T) / 2; ++k) std::swap(bytes[k], bytes[sizeof(T) - 1 - k]);
        }
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        at_ += sizeof(T);
        return value;
    }

    /// Where the next value starts.
    char const* next_value() {
        if constexpr (ascii) {
            while (at_ != end_ && is_blank(*at_)) ++at_;
        }
        return at_;
    }

    double text_scalar(channel_type type) {
        static_cast<void>(next_value());
        if (at_ == end_) fail_here(errc::truncated, "expected a number");
        if (is_integer(type)) {
            parsed_integer const r = parse_integer(at_, end_);
            double const value = static_cast<double>(r.magnitude) * (r.negative ? -1.0 : 1.0);
            if (r.state == number_state::malformed || (r.next != end_ && !is_space(*r.next))) {
                fail_here(errc::bad_number, "expected an integer");
            }
            integer_range const range = range_of(type);
            if (r.state == number_state::overflow || !(value >= range.lo && value <= range.hi)) {
                fail_here(errc::bad_number, "expected an integer that fits its type");
            }
            at_ = r.next;
            return r.magnitude == 0 ? 0.0 : value;
        }
        parsed_number const r = type == channel_type::float32 ? parse_float(at_, end_) : parse_double(at_, end_);
        if (r.state == number_state::overflow) fail_here(errc::bad_number, "expected a number that fits its type");
        if (r.state == number_state::malformed || (r.next != end_ && !is_space(*r.next))) {
            fail_here(errc::bad_number, "expected a number");
        }
        at_ = r.next;
        return r.value;
    }

    void begin_record() {
        if constexpr (ascii) {
            while (at_ != end_ && is_space(*at_)) ++at_;
        }
    }
    void end_record() {
        if constexpr (ascii) {
            while (at_ != end_ && is_blank(*at_)) ++at_;
            if (at_ != end_ && !is_line_end(*at_)) fail_here(errc::bad_syntax, "expected the end of the line");
        }
    }

    void shift_to_origin() {
        out_.origin = header_.origin;
        if (out_.origin == vec3{0, 0, 0}) return;
        for (vec3& p : out_.mesh.positions) {
            for (int axis = 0; axis < 3; ++axis) {
                // Adding zero would turn -0.0 into 0.0, and the file would not come back as it was.
                if (out_.origin[axis] != 0) p[axis] += out_.origin[axis];
            }
            if (!is_finite(p)) fail_here(errc::non_finite_vertex, "a coordinate overflows when the origin is added");
        }
    }

    [[noreturn]] void fail_here(errc code, std::string const& message, error_place place = {}) const {
        if constexpr (ascii) source_.fail_at(at_, code, message + ", got " + source_.token(at_), std::move(place));
        source_.fail_at_byte(at_, code, message, std::move(place));
    }

    source_text const& source_;
    ply_header const& header_;
    char const* at_;
    char const* end_;
    std::uint64_t vertex_count_ = 0;
    mesh_file out_{};
};

}  // namespace detail

/// Reads a PLY from memory; `name` stands in for the path in errors. O(bytes).
///
/// x, y, z become positions and vertex_indices (or vertex_index) faces, of any scalar type; every
/// other scalar property of vertex and face becomes a channel, NaN included; other lists and
/// elements are skipped. In ASCII one record is one line, numbers are decimal and rounded to the
/// declared type; coordinates are finite. Counts are checked against the bytes that are left
/// before anything is allocated. An origin recorded by `write_ply` is added to the positions.
/// \throws io_error  naming line and column in ASCII and headers, the byte in binary: `wrong_format`,
///                   `bad_syntax`, `bad_number`, `bad_count`, `truncated`, `missing_property`,
///                   `non_finite_vertex`, `index_out_of_range`, `degenerate_face`, `unsupported`, `empty_input`.
[[nodiscard]] inline mesh_file read_ply(std::string_view bytes, std::string_view name) {
    detail::source_text const source{"read_ply", bytes, name};
    detail::ply_header const header = detail::ply_header_parser(source).parse();
    switch (header.encoding) {
        case ply_encoding::little_endian:
            return detail::ply_body_parser<ply_encoding::little_endian>(source, header).parse();
        case ply_encoding::big_endian:
            return detail::ply_body_parser<ply_encoding::big_endian>(source, header).parse();
        case ply_encoding::ascii: break;
    }
    return detail::ply_body_parser<ply_encoding::ascii>(source, header).parse();
}

/// Reads a PLY file. \throws io_error  as above, and `cannot_open`, `not_a_file`.
[[nodiscard]] inline mesh_file read_ply(std::filesystem::path const& path) {
    detail::loaded_file const file = detail::load_file("read_ply", path);
    return read_ply(file.bytes(), path.string());
}

}  // namespace tafoni

#endif
