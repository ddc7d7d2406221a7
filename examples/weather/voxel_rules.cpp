#include "voxel_rules.hpp"

#include "input.hpp"
#include "spec.hpp"
#include "voxel_command.hpp"

#include <tafoni/field/noise.hpp>
#include <tafoni/voxel/bubble_shapes.hpp>
#include <tafoni/voxel/random_joints.hpp>
#include <tafoni/voxel/rates.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace weather {

using namespace tafoni;

namespace {

std::vector<std::string> pieces_of(std::string const& text) {
    std::vector<std::string> pieces(1);
    for (char const c : text) {
        if (c == ',') pieces.emplace_back();
        else pieces.back() += c;
    }
    return pieces;
}

bubble_stencil make_stencil(spec& s, std::string const& shape, double radius) {
    if (shape == "sphere") return sphere_bubble{radius};
    if (shape == "gumdrop") return gumdrop_bubble{radius, s.number("base", 2 * radius / 3, 0, 48)};
    if (shape == "disc") return disc_bubble{radius, s.number("thickness", 1, 0.1, 96)};
    if (shape == "ellipsoid") {
        vec3 const axes = s.vector("axes", {0.5 * radius, 0.5 * radius, radius});
        for (int a = 0; a < 3; ++a) {
            if (!(axes[a] > 0 && axes[a] <= 48)) s.fail("axes: three numbers above 0 and up to 48 are needed");
        }
        return ellipsoid_bubble{axes};
    }
    s.fail("known: sphere, ellipsoid, gumdrop, disc, mixture");
}

/// Adds the bubbles of one SPEC and returns their numbers. `frequency` is that of its noise.
std::vector<std::size_t> add_bubbles(spec& s, std::vector<bubble_stencil>& bubbles, double radius, double height, double& frequency) {
    std::vector<std::size_t> mix;
    if (s.name() == "mixture") {
        auto const shapes = pieces_of(s.word("shapes", "sphere,disc"));
        auto const radii = s.list("radii", std::vector<double>(shapes.size(), radius));
        if (shapes.size() != radii.size() && shapes.size() != 1) s.fail("radii: one for each of shapes is needed");
        frequency = 1 / s.number("wavelength", 0.1 * height, 1e-300, 1e300);
        for (std::size_t k = 0; k < radii.size(); ++k) {
            if (!(radii[k] >= 0.1 && radii[k] <= 48)) s.fail("radii: numbers in [0.1, 48] are needed");
            mix.push_back(bubbles.size());
            bubbles.push_back(make_stencil(s, shapes[shapes.size() == 1 ? 0 : k], radii[k]));
        }
    } else {
        mix.push_back(bubbles.size());
        bubbles.push_back(make_stencil(s, s.name(), s.number("radius", radius, 0.1, 48)));
    }
    s.done();
    return mix;
}

}  // namespace

any_bubbles parse_bubbles(std::vector<std::string> const& texts, double radius, height_range const& rock, std::uint64_t seed) {
    // The middle of the range of noise, which holds nearly all of its values, is cut into equal intervals.
    any_bubbles out{.layers = {}, .up = rock.up, .lowest = -0.5, .highest = 0.5};
    std::vector<double> frequencies;
    for (std::string const& text : texts.empty() ? std::vector<std::string>{"sphere"} : texts) {
        spec s = spec::parse("--bubble", text);
        double const above = s.number("above", 0, 0, 1);
        if (!out.layers.empty()) {
            double const below = out.layers.size() == 1 ? 0 : (out.layers[out.layers.size() - 2].top - rock.bottom) / rock.height();
            if (!(above > below)) s.fail("above: must rise from one --bubble to the next");
            out.layers.back().top = rock.bottom + above * rock.height();
        }
        double frequency = 0;
        out.layers.push_back({.mix = add_bubbles(s, out.bubbles, radius, rock.height(), frequency)});
        frequencies.push_back(frequency);
    }
    out.field = [up = rock.up, layers = out.layers, frequencies, seed](vec3 const& p) {
        std::size_t k = 0;
        while (k + 1 < layers.size() && !(dot(up, p) < layers[k].top)) ++k;
        return gradient_noise{.seed = seed, .frequency = frequencies[k]}(p);
    };
    out.validate();
    return out;
}

any_rate any_rate::parse(std::string const& text) {
    spec s = spec::parse("--rate", text);
    double const scale = s.number("scale", s.name() == "linear" ? 1 : 3, 0, 1e6);
    double const lowest = s.number("lowest", 0, 0, 1e6);
    double const highest = s.number("highest", 1e6, lowest, 1e6);
    s.done();
    any_rate out;
    auto const take = [&](auto rate) {
        out.f = s.has("lowest") || s.has("highest") ? std::function<double(double)>(clamped_rate<decltype(rate)>{rate, lowest, highest})
                                                    : std::function<double(double)>(rate);
    };
    if (s.name() == "cubic") take(cubic_rate{scale});
    else if (s.name() == "linear") take(linear_rate{scale});
    else if (s.name() == "quartic") take(quartic_rate{scale});
    else s.fail("known: cubic, linear, quartic");
    return out;
}

std::vector<voxel_phase> parse_schedule(std::string const& text, std::uint64_t steps, double spheroidal, double cavernous) {
    auto const refuse = [&](std::string const& why) { throw usage_error("--schedule " + text + ": " + why); };
    if (text.empty()) {
        return {{.steps = steps == voxel_arguments::unset ? 50 : steps, .spheroidal = spheroidal, .cavernous = std::max(cavernous, 0.0)}};
    }
    std::vector<voxel_phase> round;
    std::uint64_t length = 0;
    for (std::string const& piece : pieces_of(text)) {
        voxel_phase p;
        auto const r = std::from_chars(piece.data(), piece.data() + piece.size(), p.steps);
        std::string const letters(r.ptr, piece.data() + piece.size());
        if (r.ec != std::errc{} || p.steps == 0 || p.steps > (std::uint64_t{1} << 40)) refuse("'" + piece + "' does not start with a number of steps");
        if (letters != "s" && letters != "c" && letters != "sc" && letters != "cs") {
            refuse("'" + piece + "' does not end with s (spheroidal), c (cavernous) or sc");
        }
        p.spheroidal = letters.find('s') == std::string::npos ? 0 : spheroidal;
        p.cavernous = letters.find('c') == std::string::npos ? 0 : cavernous < 0 ? 1 : cavernous;
        length += p.steps;
        round.push_back(p);
    }
    if (steps == voxel_arguments::unset) return round;
    if (steps / length > 100000) refuse("goes round more than 100000 times in --steps " + std::to_string(steps));
    std::vector<voxel_phase> phases;
    for (std::uint64_t done = 0; done < steps;) {
        for (voxel_phase p : round) {
            p.steps = std::min(p.steps, steps - done);
            done += p.steps;
            if (p.steps > 0) phases.push_back(p);
        }
    }
    return phases;
}

joint_set parse_joints(std::vector<std::string> const& texts, box3 const& bounds, std::uint64_t seed) {
    joint_set out;
    vec3 const middle = 0.5 * (bounds.lo + bounds.hi);
    double const diagonal = bounds.diagonal();
    std::uint64_t families = 0;
    for (std::string const& text : texts) {
        spec s = spec::parse("--joints", text);
        if (s.name() == "planes") {
            vec3 const normal = s.direction("normal", {0, 0, 1});
            double const spacing = s.number("spacing", diagonal / 5, diagonal * 1e-4, 1e300);
            double const offset = s.number("offset", 0.5, 0, 1);
            double const reach = 0.5 * diagonal / spacing + 1;
            for (double k = -std::floor(reach); k <= reach; ++k) {
                out.discs.push_back({.centre = vec3{middle + (k + offset - 0.5) * spacing * normal}, .normal = normal, .radius = diagonal});
            }
        } else if (s.name() == "discs") {
            random_joints::family f{.normal = s.direction("normal", {0, 0, 1}), .spread = s.number("spread", 10, 0, 60)};
            f.spacing = s.number("spacing", diagonal / 8, 1e-100, 1e100);
            auto const radius = s.list("radius", {diagonal / 5});
            if (radius.empty() || radius.size() > 2) s.fail("radius: one number or two, least and largest, are needed");
            f.radius_min = radius.front();
            f.radius_max = radius.back();
            if (!(f.radius_min > 0 && f.radius_max >= f.radius_min && f.radius_max <= 1e100)) s.fail("radius: must be above 0 and ascend");
            joint_set const strewn = random_joints{.families = {f}}(bounds, seed + families++);
            out.discs.insert(out.discs.end(), strewn.discs.begin(), strewn.discs.end());
        } else if (s.name() == "file") {
            std::string const path = s.word("path", "");
            auto const numbers = load_reals(path);
            if (numbers.size() % 7 != 0) s.fail("path: lines of centre, normal and radius, 7 numbers, are needed");
            for (std::size_t i = 0; i < numbers.size(); i += 7) {
                double const* n = numbers.data() + i;
                out.discs.push_back({.centre = {n[0], n[1], n[2]}, .normal = {n[3], n[4], n[5]}, .radius = n[6]});
            }
        } else {
            s.fail("known: planes, discs, file");
        }
        s.done();
    }
    out.validate();
    return out;
}

}  // namespace weather
