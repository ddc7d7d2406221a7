#include "wrinkles_session.hpp"

#include "spec.hpp"

#include <tafoni/curvature/estimate_curvature.hpp>
#include <tafoni/version.hpp>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace weather {

using namespace tafoni;

namespace {

/// Numbers between commas.
std::vector<double> numbers_of(std::string const& option, std::string const& text) {
    std::vector<double> out;
    char const* at = text.data();
    char const* const end = at + text.size();
    for (;;) {
        double v = 0;
        auto const r = std::from_chars(at, end, v);
        if (r.ec != std::errc{} || !std::isfinite(v) || (r.ptr != end && *r.ptr != ',')) {
            throw usage_error(option + " " + text + ": numbers between commas are needed");
        }
        out.push_back(v);
        if (r.ptr == end) return out;
        at = r.ptr + 1;
    }
}

/// Whole numbers below 2^32 - 1.
std::vector<vertex_index> vertices_of(std::string const& option, std::string const& text) {
    std::vector<vertex_index> out;
    for (double const v : numbers_of(option, text)) {
        if (!(v >= 0 && v < vertex_index::none && v == std::floor(v))) throw usage_error(option + " " + text + ": whole numbers are needed");
        out.push_back(vertex_index{static_cast<std::size_t>(v)});
    }
    return out;
}

std::vector<vec3> points_of(std::string const& text) {
    auto const n = numbers_of("--through", text);
    if (n.size() < 6 || n.size() % 3 != 0) throw usage_error("--through " + text + ": at least two points x,y,z are needed");
    std::vector<vec3> out;
    for (std::size_t k = 0; k < n.size(); k += 3) out.push_back({n[k], n[k + 1], n[k + 2]});
    return out;
}

/// Of those that triangles use.
vertex_index nearest_vertex(triangle_surface const& s, vec3 const& p) {
    vertex_index best{0};
    double least = std::numeric_limits<double>::infinity();
    for (auto const& t : s.triangles) {
        for (std::uint32_t const v : t) {
            double const d = squared_length(s.positions[v] - p);
            if (d < least || (d == least && v < best.value)) {
                least = d;
                best = vertex_index{std::size_t{v}};
            }
        }
    }
    return best;
}

}  // namespace

wrinkles_session::wrinkles_session(wrinkles_arguments const& a)
    : a_(a), progress_(progress_style_of(a.progress)), threads_(a.threads), out_(a.output, a.formats, vec3{0, 0, 0}) {
    if (a_.paths.empty() && a_.through.empty() && a_.enlargements.empty()) {
        throw usage_error("--path, --through or --enlarge: one of them is needed");
    }
    for (std::string const& text : a_.paths) {
        if (vertices_of("--path", text).size() < 2) throw usage_error("--path " + text + ": at least two vertices are needed");
    }
    for (std::string const& text : a_.through) static_cast<void>(points_of(text));
    static_cast<void>(enlargements());
    if (a_.strength == 0) a_.strength = a_.profile == "groove" ? -1 : 1;
}

std::vector<wrinkle> wrinkles_session::wrinkles(mesh_input const& input) const {
    std::vector<wrinkle> out;
    auto const add = [&](std::vector<vertex_index> controls) {
        out.push_back({.controls = std::move(controls), .radius = a_.radius, .strength = a_.strength,
                       .profile = a_.profile == "groove" ? wrinkle_profile::groove : wrinkle_profile::fold});
    };
    for (std::string const& text : a_.paths) add(vertices_of("--path", text));
    for (std::string const& text : a_.through) {
        std::vector<vertex_index> controls;
        for (vec3 const& p : points_of(text)) {
            vertex_index const v = nearest_vertex(input.surface, p);
            if (controls.empty() || controls.back() != v) controls.push_back(v);
        }
        if (controls.size() < 2) throw usage_error("--through " + text + ": all points are nearest to one vertex");
        add(std::move(controls));
    }
    return out;
}

std::vector<enlargement> wrinkles_session::enlargements() const {
    std::vector<enlargement> out;
    for (std::string const& text : a_.enlargements) {
        auto const n = numbers_of("--enlarge", text);
        if (n.size() != 3 || !(n[0] >= 0 && n[0] < vertex_index::none && n[0] == std::floor(n[0])) || !(n[1] > 0)) {
            throw usage_error("--enlarge " + text + ": v,radius,strength are needed");
        }
        out.push_back({.centre = vertex_index{static_cast<std::size_t>(n[0])}, .radius = n[1], .strength = n[2]});
    }
    return out;
}

surface_mesh wrinkles_session::worn(wrinkle_pattern const& pattern, triangle_surface const& base, std::uint32_t times) {
    triangle_surface const flat = pattern.wear(base.positions, 0, threads_);
    triangle_surface const s = pattern.wear(base.positions, times, threads_);
    std::vector<double> wear(s.positions.size());
    for (std::size_t v = 0; v < wear.size(); ++v) wear[v] = length(s.positions[v] - flat.positions[v]);
    return mesh_with(s, {vertex_numbers("curvature", estimate_curvature(s, tensor_fit{}, threads_)), vertex_numbers("wear", std::move(wear)),
                         vertex_numbers("factor", {pattern.displacement().begin(), pattern.displacement().end()})});
}

bool wrinkles_session::run() {
    require_makable(a_.output);
    stopwatch watch;
    progress_.context().tick("read", 0);
    mesh_input const input = load_surface(a_.input, a_.seed);
    std::vector<mesh_input> others;
    for (std::string const& name : a_.wear_on) others.push_back(load_surface(name, a_.seed));
    progress_.context().tick("read", 1);
    seconds_["read"] = watch.lap();
    if (a_.radius < 0) a_.radius = input.size / 40;
    auto const lines = wrinkles(input);
    auto const swellings = enlargements();
    progress_.context().tick("weather", 0);
    wrinkle_pattern const pattern(input.surface, lines, swellings,
                                  {.divisor = a_.divisor, .subdivisions = a_.subdivisions,
                                   .formula = a_.as_printed ? wrinkle_formula::as_printed : wrinkle_formula::scale_free});
    triangle_surface const result = pattern.wear(input.surface.positions, a_.times, threads_);
    seconds_["weather"] = watch.lap();
    stopped_ = progress_.show("weather", 1) == step_control::stop;
    for (mesh_input const& other : others) {
        if (other.surface.triangles != input.surface.triangles) {
            detail::fail<invalid_input>(errc::bad_parameter, "--wear-on: its triangles are not those of " + a_.input, {.kind = entity::parameter});
        }
    }
    // Made only now that the input has been accepted, so that a refused run leaves nothing behind.
    std::filesystem::path const folder = made_folder(a_.output);
    vec3 origin{0, 0, 0};
    for (int k = 0; k < 3; ++k) origin[k] = std::floor(input.bounds.lo[k]);
    out_ = output_folder(folder, a_.formats, origin);
    out_.remove_old("wrinkles", [](std::uint64_t) { return false; });
    out_.write("weathered", worn(pattern, input.surface, a_.times));
    for (std::size_t k = 0; k < others.size() && !stopped_; ++k) {
        out_.write("worn_" + std::to_string(k), worn(pattern, others[k].surface, a_.times));
        stopped_ = progress_.show("write", static_cast<double>(k) / static_cast<double>(others.size())) == step_control::stop;
    }
    seconds_["write"] = watch.lap();
    write_report(input, pattern, volume_of(result, input.bounds));
    progress_.show("write", 1);
    std::fprintf(stderr, "%s: %zu wrinkles, %zu vertices added\n", a_.output.c_str(), lines.size(),
                 result.positions.size() - input.surface.positions.size());
    return !stopped_;
}

void wrinkles_session::write_report(mesh_input const& input, wrinkle_pattern const& pattern, double volume) const {
    nlohmann::ordered_json paths = nlohmann::ordered_json::array();
    for (auto const& path : pattern.paths()) {
        nlohmann::ordered_json line = nlohmann::ordered_json::array();
        for (vertex_index const v : path) line.push_back(v.value);
        paths.push_back(std::move(line));
    }
    nlohmann::ordered_json j;
    j["schema"] = "tafoni.weather.wrinkles/1";
    j["version"] = version_string;
    j["process"] = "wrinkles";
    j["input"] = a_.input;
    j["seed"] = a_.seed;
    j["parameters"] = {{"path", a_.paths}, {"through", a_.through}, {"enlarge", a_.enlargements}, {"radius", a_.radius},
                       {"strength", a_.strength}, {"profile", a_.profile}, {"times", a_.times}, {"divisor", a_.divisor},
                       {"subdivisions", a_.subdivisions}, {"as_printed", a_.as_printed}, {"wear_on", a_.wear_on}, {"format", a_.formats}};
    j["mesh"] = json_of(input);
    j["bounds"] = {{"lo", json_of(input.bounds.lo)}, {"hi", json_of(input.bounds.hi)}};
    j["threads"] = a_.threads;
    j["stopped"] = stopped_ ? "interrupted" : "finished";
    j["repaired"] = input.repaired;
    j["vertices"] = pattern.displacement().size();
    j["faces"] = pattern.triangles().size();
    j["vertices_added"] = pattern.midpoints().size();
    j["volume_before"] = volume_of(input.surface, input.bounds);
    j["volume_after"] = volume;
    j["seconds"] = seconds_;
    j["paths"] = paths;
    out_.write_text("report.json", j.dump(2) + "\n");
}

}  // namespace weather
