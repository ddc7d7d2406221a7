#include "wrinkles_session.hpp"

#include "input.hpp"
#include "notes.hpp"
#include "spec.hpp"

#include <tafoni/core/detail/bytes.hpp>
#include <tafoni/io/wrinkle_channels.hpp>
#include <tafoni/version.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <span>

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

constexpr std::uint64_t checkpoint_magic = 0x6972772D66617400ULL;  // "\0taf-wri"

/// Tells apart what a checkpoint could belong to.
std::uint64_t pattern_hash(wrinkle_pattern const& pattern, triangle_surface const& base) {
    detail::number_hash h;
    for (vec3 const& p : base.positions) {
        for (int d = 0; d < 3; ++d) h.add(p[d]);
    }
    for (auto const& t : pattern.triangles()) {
        for (std::uint32_t const c : t) h.add(std::uint64_t{c});
    }
    for (double const d : pattern.displacement()) h.add(d);
    return h.value();
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
    if (a_.paths.empty() && a_.through.empty()) {
        wrinkles_arguments const plain;
        unused_.tell("without --path or --through", {{"--radius", a_.radius > 0}, {"--strength", !std::isnan(a_.strength)}, {"--profile", a_.profile != plain.profile},
                                                     {"--as-printed", a_.as_printed}});
    }
    if (std::isnan(a_.strength)) a_.strength = a_.profile == "groove" ? -2 : 1;
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

surface_mesh wrinkles_session::worn(wrinkle_pattern const& pattern, triangle_surface const& flat, triangle_surface const& now) const {
    return mesh_with(now, channels_of(pattern, flat, now, tensor_fit{}, threads_).vertex_channels);
}

bool wrinkles_session::run() {
    require_makable(a_.output);
    if (!a_.checkpoint.empty()) {
        std::filesystem::path const folder = std::filesystem::path(a_.checkpoint).parent_path();
        require_makable(folder.empty() ? "." : folder.string());
    }
    stopwatch watch;
    progress_.context().tick("read", 0);
    mesh_input const input = load_surface(a_.input, a_.seed);
    tell_repairs(input);
    std::vector<mesh_input> others;
    for (std::string const& name : a_.wear_on) {
        others.push_back(load_surface(name, a_.seed));
        if (others.back().surface.triangles != input.surface.triangles) {
            detail::fail<invalid_input>(errc::bad_parameter, "--wear-on " + name + ": its triangles are not those of " + a_.input,
                                        {.kind = entity::file, .file = name});
        }
    }
    progress_.context().tick("read", 1);
    seconds_["read"] = watch.lap();
    if (a_.radius < 0) a_.radius = std::max(input.size / 40, input.mean_edge());
    auto const lines = wrinkles(input);
    auto const swellings = enlargements();
    progress_.context().tick("weather", 0);
    wrinkle_pattern const pattern(input.surface, lines, swellings,
                                  {.divisor = a_.divisor, .subdivisions = a_.subdivisions,
                                   .formula = a_.as_printed ? wrinkle_formula::as_printed : wrinkle_formula::scale_free});
    triangle_surface const flat = pattern.wear(input.surface.positions, 0, threads_);
    hash_ = pattern_hash(pattern, flat);
    triangle_surface result = flat;
    if (!a_.resume.empty()) resume(result);
    make_folder(input);
    weather(pattern, flat, result);
    seconds_["weather"] = watch.lap() - aside_;
    auto const factor = pattern.displacement();
    if (std::all_of(factor.begin(), factor.end(), [](double f) { return f == 0; })) {
        std::fprintf(stderr, "nothing moves: no vertex lies within --radius %g of a line; more --subdivisions or a larger --radius help\n", a_.radius);
    }
    out_.write("weathered", worn(pattern, flat, result));
    for (std::size_t k = 0; k < others.size() && !stopped_; ++k) {
        triangle_surface const before = pattern.wear(others[k].surface.positions, 0, threads_);
        out_.write("worn_" + std::to_string(k), worn(pattern, before, pattern.wear_again(before, done_, threads_)));
        stopped_ = progress_.show("write", static_cast<double>(k) / static_cast<double>(others.size())) == step_control::stop;
    }
    std::string checkpoint = a_.checkpoint;
    if (checkpoint.empty() && stopped_) checkpoint = (out_.folder() / "wrinkles.checkpoint").string();
    if (!checkpoint.empty()) write_checkpoint(result, checkpoint);
    if (stopped_) std::fprintf(stderr, "stopped; go on with --resume %s\n", checkpoint.c_str());
    if (a_.snapshots > 0 && out_.writes("vtp")) series_.finish(out_);
    seconds_["write"] = watch.lap() + aside_;
    cut_counts const cuts = cut_counts::of(input.surface, result);
    seconds_["check"] = watch.lap();
    write_report(input, pattern, volume_of(result, input.bounds), cuts);
    progress_.show("write", 1);
    std::fprintf(stderr, "%s: %zu wrinkles, %zu enlargements, %zu vertices added\n", a_.output.c_str(), lines.size(), a_.enlargements.size(),
                 result.positions.size() - input.surface.positions.size());
    cuts.tell("a smaller --strength or --radius, a larger --divisor or fewer --times prevent it");
    return !stopped_;
}

void wrinkles_session::make_folder(mesh_input const& input) {
    // Made only now that the input has been accepted, so that a refused run leaves nothing behind.
    std::filesystem::path const folder = made_folder(a_.output);
    vec3 origin{0, 0, 0};
    for (int k = 0; k < 3; ++k) origin[k] = std::floor(input.bounds.lo[k]);
    out_ = output_folder(folder, a_.formats, origin);
    if (a_.snapshots > 0) made_folder((folder / "snapshots").string());
    out_.remove_old("wrinkles", [&](std::uint64_t n) { return !a_.resume.empty() && n <= done_; });
}

void wrinkles_session::weather(wrinkle_pattern const& pattern, triangle_surface const& flat, triangle_surface& now) {
    if (!a_.resume.empty()) series_.recall(out_, a_.snapshots, done_);
    for (;;) {
        if (a_.snapshots > 0 && done_ % a_.snapshots == 0) {
            stopwatch watch;
            series_.write(out_, done_, worn(pattern, flat, now));
            if (!a_.checkpoint.empty()) write_checkpoint(now, a_.checkpoint);
            aside_ += watch.lap();
        }
        double const share = a_.times == 0 ? 1 : static_cast<double>(done_) / static_cast<double>(a_.times);
        bool const asked_to_stop = progress_.show("weather", share, std::to_string(done_) + " times") == step_control::stop;
        if (done_ >= a_.times) return;
        stopped_ = asked_to_stop;
        if (stopped_) return;
        now = pattern.wear_again(std::move(now), 1, threads_);
        ++done_;
    }
}

void wrinkles_session::write_checkpoint(triangle_surface const& now, std::string const& path) const {
    detail::byte_writer out;
    out.put(checkpoint_magic);
    out.put(hash_);
    out.put(done_, 4);
    for (vec3 const& p : now.positions) {
        for (int d = 0; d < 3; ++d) out.put_real(p[d]);
    }
    out.put(detail::byte_hash(out.bytes()));
    detail::write_file("weather", path, {reinterpret_cast<char const*>(out.bytes().data()), out.bytes().size()});
}

void wrinkles_session::resume(triangle_surface& now) {
    std::string const text = load_bytes(a_.resume);
    auto const bytes = std::as_bytes(std::span(text.data(), text.size()));
    auto const refuse = [&](errc code, char const* why) {
        detail::fail<io_error>(code, a_.resume + ": " + why, {.kind = entity::file, .file = a_.resume});
    };
    detail::byte_reader in(bytes, "--resume");
    if (bytes.size() < 28 || in.get() != checkpoint_magic) refuse(errc::wrong_format, "these bytes are no checkpoint of wrinkles");
    if (in.get() != hash_) refuse(errc::checkpoint_mismatch, "the checkpoint belongs to another mesh or other wrinkles");
    if (bytes.size() != 28 + 24 * now.positions.size()) refuse(errc::truncated, "the checkpoint has another length");
    if (detail::byte_reader(bytes.last(8), "--resume").get() != detail::byte_hash(bytes.first(bytes.size() - 8))) {
        refuse(errc::bad_syntax, "the checksum is wrong");
    }
    done_ = static_cast<std::uint32_t>(in.get(4));
    if (done_ > a_.times) throw usage_error("--times " + std::to_string(a_.times) + ": the checkpoint has " + std::to_string(done_));
    for (vec3& p : now.positions) {
        for (int d = 0; d < 3; ++d) p[d] = in.get_real();
    }
}

void wrinkles_session::write_report(mesh_input const& input, wrinkle_pattern const& pattern, double volume, cut_counts const& cuts) const {
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
                       {"subdivisions", a_.subdivisions}, {"as_printed", a_.as_printed}, {"wear_on", a_.wear_on}, {"snapshots", a_.snapshots}, {"format", a_.formats}};
    j["unused"] = unused_.json();
    j["mesh"] = json_of(input);
    j["bounds"] = {{"lo", json_of(input.bounds.lo)}, {"hi", json_of(input.bounds.hi)}};
    j["threads"] = a_.threads;
    j["times"] = done_;
    j["stopped"] = stopped_ ? "interrupted" : "finished";
    j["repaired"] = input.repaired;
    j["vertices"] = pattern.displacement().size();
    j["faces"] = pattern.triangles().size();
    j["vertices_added"] = pattern.midpoints().size();
    j["volume_before"] = volume_of(input.surface, input.bounds);
    j["volume_after"] = volume;
    j["self_intersections"] = cuts.json();
    j["seconds"] = seconds_;
    j["paths"] = paths;
    out_.write_text("report.json", j.dump(2) + "\n");
}

}  // namespace weather
