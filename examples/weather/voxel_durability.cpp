#include "voxel_durability.hpp"

#include "nrrd.hpp"
#include "spec.hpp"

#include <tafoni/field/durability_profile.hpp>
#include <tafoni/field/fractal_noise.hpp>
#include <tafoni/field/grid_field.hpp>
#include <tafoni/field/remapped.hpp>
#include <tafoni/io/read_durability.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace weather {

using namespace tafoni;

namespace {

constexpr double most = 1e9;

void require_durable(spec const& s, std::vector<double> const& values) {
    for (double const v : values) {
        if (!(v >= 0 && v <= most)) s.fail("values: a durability lies in [0, 1e9]");
    }
}

/// Corners of a curve over shares of the height.
std::vector<durability_point> corners_of(spec& s) {
    auto const at = s.list("at", {0, 1});
    auto const values = s.list("values", std::vector<double>(at.size(), 0.01));
    if (at.empty() || values.size() != at.size()) s.fail("values: as many as at are needed");
    std::vector<durability_point> points;
    require_durable(s, values);
    for (std::size_t k = 0; k < at.size(); ++k) points.push_back({.altitude = at[k], .durability = values[k]});
    auto const spread = [&](char const* key, double durability_point::* member) {
        auto const list = s.list(key, {0});
        if (list.size() != 1 && list.size() != at.size()) s.fail(std::string(key) + ": one number, or as many as at are needed");
        for (std::size_t k = 0; k < at.size(); ++k) points[k].*member = list[list.size() == 1 ? 0 : k];
    };
    spread("amplitude", &durability_point::amplitude);
    spread("frequency", &durability_point::frequency);
    return points;
}

/// Beds with sharp boundaries; the values repeat from the bottom to the top.
std::vector<durability_point> beds_of(spec& s) {
    auto const values = s.list("values", {0.006, 0.03});
    require_durable(s, values);
    double const thickness = s.number("thickness", 1.0 / static_cast<double>(2 * values.size()), 1e-4, 1);
    std::vector<durability_point> points;
    std::size_t k = 0;
    for (double bottom = 0; bottom < 1; bottom += thickness, ++k) {
        points.push_back({.altitude = bottom, .durability = values[k % values.size()]});
        points.push_back({.altitude = std::min(bottom + thickness, 1.0), .durability = values[k % values.size()]});
    }
    return points;
}

any_field grid_durability(spec& s, box3 const& bounds) {
    std::string const path = s.word("path", "");
    if (path.empty()) s.fail("path: a .nrrd file is needed");
    auto const volume = std::make_shared<nrrd_volume const>(read_nrrd(path));
    grid_field<float> field{.samples = volume->samples, .size = volume->size, .origin = volume->origin, .spacing = volume->spacing};
    bool const fit = s.word("place", "file") == "fit";
    if (fit || !volume->placed) {
        field.origin = bounds.lo;
        for (int a = 0; a < 3; ++a) {
            field.spacing[a] = bounds.extent()[a] / static_cast<double>(std::max<std::size_t>(volume->size[static_cast<std::size_t>(a)], 2) - 1);
        }
    }
    field.validate();
    auto const [least, largest] = std::minmax_element(volume->samples.begin(), volume->samples.end());
    double const lo = double{*least};
    double const hi = *largest > *least ? double{*largest} : lo + 1;
    remapped const scaled{field, lo, hi, s.number("low", 0.005, 0, most), s.number("high", 0.03, 0, most)};
    return [volume, scaled](vec3 const& p) { return scaled(p); };
}

}  // namespace

any_field make_durability(std::string const& text, std::string const& noise, height_range const& rock,
                          box3 const& bounds, std::uint64_t seed) {
    any_field extra = [](vec3 const&) { return 0.0; };
    if (!noise.empty()) {
        spec s = spec::parse("--noise", noise);
        if (s.name() != "noise") s.fail("known: noise");
        double const amplitude = s.number("amplitude", 0.003, 0, most);
        double const wavelength = s.number("wavelength", 0.1 * rock.height(), 1e-300, 1e300);
        fractal_noise const waves{.seed = seed + 1, .frequency = 1 / wavelength, .octaves = static_cast<unsigned>(s.number("octaves", 3, 0, 64))};
        s.done();
        // Fractal sums rarely leave the middle half of their range.
        extra = remapped{waves, -0.5, 0.5, -amplitude, amplitude};
    }
    durability_profile<any_field> profile{.up = rock.up, .seed = seed, .extra = extra};
    std::error_code ignored;
    if (std::filesystem::is_regular_file(text, ignored)) {
        durability_table table = read_durability(std::filesystem::path(text));
        profile.points = table.relative ? scaled_durability(std::move(table.points), rock.bottom, rock.top) : std::move(table.points);
        profile.validate();
        return profile;
    }
    spec s = spec::parse("--durability", text);
    if (s.name() == "constant") {
        profile.points = {{.durability = s.number("value", 0.01, 0, most)}};
    } else if (s.name() == "profile" || s.name() == "layers") {
        profile.points = scaled_durability(s.name() == "profile" ? corners_of(s) : beds_of(s), rock.bottom, rock.top);
    } else if (s.name() == "grid") {
        any_field const samples = grid_durability(s, bounds);
        profile.points = {{.durability = 0}};
        profile.extra = [samples, extra](vec3 const& p) { return samples(p) + extra(p); };
    } else {
        s.fail("no such file; known: constant, profile, layers, grid");
    }
    s.done();
    profile.validate();
    return profile;
}

}  // namespace weather
