#include "resistance.hpp"

#include "nrrd.hpp"

#include <tafoni/core/random.hpp>
#include <tafoni/field/grid_field.hpp>
#include <tafoni/field/jittered.hpp>
#include <tafoni/field/pockets.hpp>
#include <tafoni/field/ramp.hpp>
#include <tafoni/field/remapped.hpp>
#include <tafoni/field/sine.hpp>
#include <tafoni/field/strata.hpp>
#include <tafoni/geometry/inside_columns.hpp>

#include <algorithm>
#include <memory>

namespace weather {

using namespace tafoni;

namespace {

void require_shares(spec const& s, std::vector<double> const& values) {
    for (double const v : values) {
        if (!(v >= 0 && v <= 1)) s.fail("values: a resistance lies in [0, 1]");
    }
}

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

any_field make_layers(spec& s, solid const& body, vec3 const& down_up, std::uint64_t seed) {
    vec3 const up = s.direction("up", down_up);
    auto const values = s.list("values", {0.3, 0.8});
    if (values.empty()) s.fail("values: at least one is needed");
    require_shares(s, values);
    auto const [lo, hi] = altitudes(body.bounds, up);
    strata layers{.up = up, .tops = s.list("tops"), .values = values};
    if (layers.tops.empty()) {
        // Without tops the values repeat, layer by layer, from the bottom to the top.
        double const thickness = s.number("thickness", (hi - lo) / 6, (hi - lo) * 1e-4, 1e300);
        layers.values.clear();
        for (double top = lo + thickness; top < hi; top += thickness) layers.tops.push_back(top);
        for (std::size_t k = 0; k <= layers.tops.size(); ++k) layers.values.push_back(values[k % values.size()]);
    }
    if (layers.values.size() != layers.tops.size() + 1) s.fail("values: one more than tops is needed");
    double const fold = s.number("fold", 0, 0, 1e300);
    double const wavelength = s.number("wavelength", (hi - lo) / 2, 1e-300, 1e300);
    layers.validate();
    if (fold == 0) return layers;
    return jittered{layers, fold, fractal_noise{.seed = seed, .frequency = 1 / wavelength, .octaves = 3}};
}

any_field make_pockets(spec& s, solid const& body, std::uint64_t seed) {
    auto const count = static_cast<std::size_t>(s.number("count", 20, 0, 100000));
    double const radius = s.number("radius", 0.08 * body.bounds.diagonal(), 1e-300, 1e300);
    double const value = s.number("value", 0.95, 0, 1);
    pockets<> field{.base = {.value = s.number("base", 0.4, 0, 1)}};
    inside_columns const rock(body);
    for (std::size_t i = 0; i < count; ++i) {
        stream random(seed, stage::user, i);
        pocket p{.value = value};
        for (int tries = 0; tries < 1000000; ++tries) {
            for (int a = 0; a < 3; ++a) p.centre[a] = random.uniform(body.bounds.lo[a], body.bounds.hi[a]);
            if (rock.contains(p.centre)) break;
        }
        for (int a = 0; a < 3; ++a) p.radii[a] = radius * random.uniform(0.6, 1.4);
        field.bodies.push_back(p);
    }
    return field;
}

any_field make_grid(spec& s, solid const& body) {
    std::string const path = s.word("path", "");
    if (path.empty()) s.fail("path: a .nrrd file is needed");
    auto const volume = std::make_shared<nrrd_volume const>(read_nrrd(path));
    vec3 const extent = body.bounds.extent();
    grid_field<float> field{.samples = volume->samples, .size = volume->size, .origin = volume->origin, .spacing = volume->spacing};
    bool const fit = s.word("place", "file") == "fit";
    if (fit || !volume->placed) {
        field.origin = body.bounds.lo;
        for (int a = 0; a < 3; ++a) {
            field.spacing[a] = extent[a] / static_cast<double>(std::max<std::size_t>(volume->size[static_cast<std::size_t>(a)], 2) - 1);
        }
    }
    field.validate();
    auto const [least, most] = std::minmax_element(volume->samples.begin(), volume->samples.end());
    auto range = s.list("range", {double{*least}, double{*most}});
    if (range.size() != 2) s.fail("range: two numbers are needed");
    if (!(range[1] > range[0])) range[1] = range[0] + 1;
    double const low = s.number("low", 0.2, 0, 1);
    double const high = s.number("high", 0.9, 0, 1);
    remapped const scaled{field, range[0], range[1], low, high};
    return [volume, scaled](vec3 const& p) { return scaled(p); };
}

}  // namespace

any_field make_resistance(std::string const& text, solid const& body, vec3 const& up, std::uint64_t seed) {
    spec s = spec::parse("--resistance", text);
    auto const [lo, hi] = altitudes(body.bounds, up);
    any_field field;
    if (s.name() == "constant") {
        field = constant_field{.value = s.number("value", 0.5, 0, 1)};
    } else if (s.name() == "layers") {
        field = make_layers(s, body, up, seed);
    } else if (s.name() == "sine") {
        double const wavelength = s.number("wavelength", (hi - lo) / 4, 1e-300, 1e300);
        vec3 const along = s.direction("direction", up);
        double const mean = s.number("mean", 0.5, 0, 1);
        double const amplitude = s.number("amplitude", std::min(mean, 1 - mean), 0, std::min(mean, 1 - mean));
        vec3 wave{0, 0, 0};
        for (int a = 0; a < 3; ++a) wave[a] = 6.283185307179586 / wavelength * along[a];
        field = sine_field{.wave = wave, .phase = s.number("phase", 0, -1e9, 1e9), .mean = mean, .amplitude = amplitude};
    } else if (s.name() == "ramp") {
        vec3 const along = s.direction("direction", up);
        auto const [from, to] = altitudes(body.bounds, along);
        ramp_field const ramp{.start = vec3{along * from},
                              .end = vec3{along * to},
                              .at_start = s.number("low", 0.2, 0, 1),
                              .at_end = s.number("high", 0.9, 0, 1)};
        ramp.validate();
        field = ramp;
    } else if (s.name() == "pockets") {
        field = make_pockets(s, body, seed);
    } else if (s.name() == "noise") {
        double const wavelength = s.number("wavelength", 0.25 * body.bounds.diagonal(), 1e-300, 1e300);
        fractal_noise const noise{.seed = seed,
                                  .frequency = 1 / wavelength,
                                  .octaves = static_cast<unsigned>(s.number("octaves", 4, 0, 64))};
        double const low = s.number("low", 0.2, 0, 1);
        double const high = s.number("high", 0.9, 0, 1);
        // Fractal sums rarely leave the middle half of their range.
        field = remapped{noise, -0.5, 0.5, low, high};
    } else if (s.name() == "grid") {
        field = make_grid(s, body);
    } else {
        s.fail("known: constant, layers, sine, ramp, pockets, noise, grid");
    }
    s.done();
    return field;
}

}  // namespace weather
