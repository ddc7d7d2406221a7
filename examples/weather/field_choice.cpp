#include "field_choice.hpp"

#include "nrrd.hpp"
#include "spec.hpp"

#include <tafoni/field/durability_profile.hpp>
#include <tafoni/field/fractal_noise.hpp>
#include <tafoni/field/grid_field.hpp>
#include <tafoni/field/jittered.hpp>
#include <tafoni/field/ramp.hpp>
#include <tafoni/field/remapped.hpp>
#include <tafoni/field/strata.hpp>
#include <tafoni/io/read_durability.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <sstream>

namespace weather {

using namespace tafoni;

namespace {

struct limits {
    double least;
    double most;
};

/// Lowest and highest altitude of the box.
std::pair<double, double> altitudes(box3 const& box, vec3 const& up) {
    double lo = 0;
    double hi = 0;
    for (int a = 0; a < 3; ++a) {
        lo += std::min(up[a] * box.lo[a], up[a] * box.hi[a]);
        hi += std::max(up[a] * box.lo[a], up[a] * box.hi[a]);
    }
    return {lo, hi};
}

any_field layers_of(spec& s, limits const& in, field_frame const& frame) {
    vec3 const up = s.direction("up", frame.up);
    auto const [lo, hi] = altitudes(frame.bounds, up);
    auto const values = s.list("values", {1, 4});
    for (double const v : values) {
        if (!(v >= in.least && v <= in.most)) s.fail("values: one is out of range");
    }
    double const height = hi > lo ? hi - lo : 1;
    double const thickness = s.number("thickness", height / 6, height * 1e-4, 1e300);
    strata layers{.up = up, .tops = {}, .values = {}};
    for (double top = lo + thickness; top < hi; top += thickness) layers.tops.push_back(top);
    for (std::size_t k = 0; k <= layers.tops.size(); ++k) layers.values.push_back(values[k % values.size()]);
    double const fold = s.number("fold", 0, 0, 1e300);
    double const wavelength = s.number("wavelength", height / 2, 1e-300, 1e300);
    layers.validate();
    if (fold == 0) return layers;
    return jittered{layers, fold, fractal_noise{.seed = frame.seed + 2, .frequency = 1 / wavelength, .octaves = 3}};
}

any_field grid_of(spec& s, limits const& in, field_frame const& frame) {
    std::string const path = s.word("path", "");
    if (path.empty()) s.fail("path: a .nrrd file is needed");
    auto const volume = std::make_shared<nrrd_volume const>(read_nrrd(path));
    grid_field<float> field{.samples = volume->samples, .size = volume->size, .origin = volume->origin, .spacing = volume->spacing};
    bool const fit = s.word("place", "file") == "fit";
    if (fit || !volume->placed) {
        field.origin = frame.bounds.lo;
        for (int a = 0; a < 3; ++a) {
            double const e = frame.bounds.extent()[a] > 0 ? frame.bounds.extent()[a] : 1.0;
            field.spacing[a] = e / static_cast<double>(std::max<std::size_t>(volume->size[static_cast<std::size_t>(a)], 2) - 1);
        }
    }
    field.validate();
    auto const [least, largest] = std::minmax_element(volume->samples.begin(), volume->samples.end());
    double const lo = double{*least};
    double const hi = *largest > *least ? double{*largest} : lo + 1;
    double const low = s.number("low", 1, in.least, in.most);
    double const high = s.number("high", 4, in.least, in.most);
    remapped const scaled{field, lo, hi, low, high};
    return any_field([volume, scaled](vec3 const& p) -> double { return scaled(p); });
}

}  // namespace

any_field make_field(std::string const& option, std::string const& text, double least, double most, field_frame const& frame) {
    limits const in{least, most};
    double value = 0;
    auto const r = std::from_chars(text.data(), text.data() + text.size(), value);
    if (!text.empty() && r.ec == std::errc{} && r.ptr == text.data() + text.size()) {
        if (!(value >= least && value <= most)) {
            std::ostringstream why;
            why << option << ' ' << text << ": is not in [" << least << ", " << most << "]";
            throw usage_error(why.str());
        }
        return value;
    }
    std::error_code ignored;
    if (std::filesystem::is_regular_file(text, ignored)) {
        auto const [lo, hi] = altitudes(frame.bounds, frame.up);
        durability_table table = read_durability(std::filesystem::path(text));
        durability_profile<> profile{.up = frame.up, .points = {}, .seed = frame.seed, .floor = least > 0 ? least : 1e-300};
        profile.points = table.relative ? scaled_durability(std::move(table.points), lo, hi) : std::move(table.points);
        profile.validate();
        return profile;
    }
    spec s = spec::parse(option, text);
    any_field field;
    if (s.name() == "constant") {
        field = s.number("value", 1, least, most);
    } else if (s.name() == "layers") {
        field = layers_of(s, in, frame);
    } else if (s.name() == "ramp") {
        vec3 const along = s.direction("direction", frame.up);
        auto const [from, to] = altitudes(frame.bounds, along);
        ramp_field const ramp{.start = vec3{along * from}, .end = vec3{along * to}, .at_start = s.number("low", 1, least, most),
                              .at_end = s.number("high", 4, least, most)};
        ramp.validate();
        field = ramp;
    } else if (s.name() == "noise") {
        double const wavelength = s.number("wavelength", 0.1 * frame.bounds.diagonal(), 1e-300, 1e300);
        fractal_noise const noise{.seed = frame.seed + 1, .frequency = 1 / wavelength,
                                  .octaves = static_cast<unsigned>(s.number("octaves", 4, 0, 64))};
        double const low = s.number("low", 1, least, most);
        double const high = s.number("high", 4, least, most);
        // Fractal sums rarely leave the middle half of their range.
        field = remapped{noise, -0.5, 0.5, low, high};
    } else if (s.name() == "grid") {
        field = grid_of(s, in, frame);
    } else {
        s.fail("no such file; a number, or one of constant, layers, ramp, noise, grid");
    }
    s.done();
    return field;
}

}  // namespace weather
