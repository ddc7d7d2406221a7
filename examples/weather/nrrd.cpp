#include "nrrd.hpp"

#include "input.hpp"

#include <tafoni/core/error.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>

namespace weather {

namespace {

[[noreturn]] void refuse(tafoni::errc code, std::string const& path, std::string const& why) {
    tafoni::detail::fail<tafoni::io_error>(code, "read_nrrd: " + path + ": " + why,
                                           {.kind = tafoni::entity::file, .file = path});
}

template <class T>
float sample_at(char const* bytes) {
    T v;
    std::memcpy(&v, bytes, sizeof v);
    return static_cast<float>(v);
}

/// All numbers of a text, with brackets and commas as blanks.
std::vector<double> numbers_of(std::string text) {
    for (char& c : text) {
        if (c == '(' || c == ')' || c == ',') c = ' ';
    }
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    std::vector<double> r;
    for (double v = 0; in >> v;) r.push_back(v);
    return r;
}

}  // namespace

nrrd_volume read_nrrd(std::string const& path) {
    std::string const bytes = load_bytes(path);
    if (bytes.rfind("NRRD", 0) != 0) refuse(tafoni::errc::wrong_format, path, "does not begin with NRRD");
    std::map<std::string, std::string> fields;
    std::size_t at = 0;
    for (;;) {
        std::size_t const end = bytes.find('\n', at);
        if (end == std::string::npos) refuse(tafoni::errc::truncated, path, "the header does not end");
        std::string line = bytes.substr(at, end - at);
        at = end + 1;
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.empty()) break;
        std::size_t const colon = line.find(':');
        if (line[0] == '#' || colon == std::string::npos) continue;
        std::size_t value = colon + 1;
        while (value < line.size() && (line[value] == ' ' || line[value] == '=')) ++value;
        fields[line.substr(0, colon)] = line.substr(value);
    }
    if (fields["encoding"] != "raw") refuse(tafoni::errc::unsupported, path, "encoding '" + fields["encoding"] + "', only raw is read");
    if (fields.count("data file") != 0) refuse(tafoni::errc::unsupported, path, "detached data is not read");
    if (fields["endian"] == "big") refuse(tafoni::errc::unsupported, path, "big endian is not read");
    static std::map<std::string, std::pair<std::size_t, float (*)(char const*)>> const types{
        {"uint8", {1, sample_at<std::uint8_t>}},   {"uchar", {1, sample_at<std::uint8_t>}},
        {"unsigned char", {1, sample_at<std::uint8_t>}}, {"int8", {1, sample_at<std::int8_t>}},
        {"uint16", {2, sample_at<std::uint16_t>}}, {"ushort", {2, sample_at<std::uint16_t>}},
        {"int16", {2, sample_at<std::int16_t>}},   {"short", {2, sample_at<std::int16_t>}},
        {"uint32", {4, sample_at<std::uint32_t>}}, {"int32", {4, sample_at<std::int32_t>}},
        {"int", {4, sample_at<std::int32_t>}},     {"float", {4, sample_at<float>}},
        {"double", {8, sample_at<double>}}};
    auto const type = types.find(fields["type"]);
    if (type == types.end()) refuse(tafoni::errc::unsupported, path, "type '" + fields["type"] + "'");
    auto const sizes = numbers_of(fields["sizes"]);
    if (sizes.size() != 3) refuse(tafoni::errc::unsupported, path, "three sizes are needed");
    nrrd_volume v;
    double total = 1;
    for (std::size_t a = 0; a < 3; ++a) {
        if (!(sizes[a] >= 1 && sizes[a] <= 1e6)) refuse(tafoni::errc::bad_count, path, "a size is out of range");
        v.size[a] = static_cast<std::size_t>(sizes[a]);
        total *= sizes[a];
    }
    auto const [width, read] = type->second;
    if (!(total * static_cast<double>(width) <= static_cast<double>(bytes.size() - at))) {
        refuse(tafoni::errc::truncated, path, "fewer samples than the sizes say");
    }
    v.samples.resize(v.size[0] * v.size[1] * v.size[2]);
    for (std::size_t i = 0; i < v.samples.size(); ++i) v.samples[i] = read(bytes.data() + at + i * width);
    auto const directions = numbers_of(fields["space directions"]);
    auto const spacings = numbers_of(fields["spacings"]);
    auto const origin = numbers_of(fields["space origin"]);
    for (int a = 0; a < 3; ++a) {
        auto const k = static_cast<std::size_t>(a);
        if (directions.size() == 9) v.spacing[a] = std::fabs(directions[4 * k]);
        else if (spacings.size() == 3) v.spacing[a] = spacings[k];
        if (origin.size() == 3) v.origin[a] = origin[k];
    }
    v.placed = origin.size() == 3;
    return v;
}

}  // namespace weather
