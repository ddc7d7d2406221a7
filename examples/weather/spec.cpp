#include "spec.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

namespace weather {

namespace {

std::vector<std::string> split(std::string const& text) {
    std::vector<std::string> pieces(1);
    for (char const c : text) {
        if (c == ',') pieces.emplace_back();
        else pieces.back() += c;
    }
    return pieces;
}

bool parse_number(std::string const& text, double& value) {
    char const* first = text.data();
    char const* const last = first + text.size();
    if (first != last && *first == '+') ++first;
    auto const r = std::from_chars(first, last, value);
    return r.ec == std::errc{} && r.ptr == last && std::isfinite(value);
}

}  // namespace

spec spec::parse(std::string option, std::string const& text) {
    spec s;
    s.option_ = std::move(option);
    s.text_ = text;
    std::size_t const colon = text.find(':');
    s.name_ = text.substr(0, colon);
    if (s.name_.empty()) s.fail("a name is missing");
    if (colon == std::string::npos) return s;
    std::string key;
    for (std::string const& piece : split(text.substr(colon + 1))) {
        std::size_t const equals = piece.find('=');
        if (equals == std::string::npos) {
            if (key.empty()) s.fail("'" + piece + "' is not key=value");
            s.values_[key].push_back(piece);
            continue;
        }
        key = piece.substr(0, equals);
        if (key.empty()) s.fail("a key is missing before '='");
        if (s.values_.count(key) != 0) s.fail("key '" + key + "' is given twice");
        s.values_[key].push_back(piece.substr(equals + 1));
    }
    return s;
}

void spec::fail(std::string const& why) const { throw usage_error(option_ + " " + text_ + ": " + why); }

bool spec::has(std::string const& key) {
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
    return values_.count(key) != 0;
}

std::vector<double> spec::list(std::string const& key, std::vector<double> otherwise) {
    if (!has(key)) return otherwise;
    std::vector<double> numbers;
    for (std::string const& piece : values_[key]) {
        double v = 0;
        if (!parse_number(piece, v)) fail(key + ": '" + piece + "' is not a number");
        numbers.push_back(v);
    }
    return numbers;
}

double spec::number(std::string const& key, double otherwise, double lo, double hi) {
    auto const numbers = list(key, {otherwise});
    if (numbers.size() != 1) fail(key + ": one number is needed");
    if (!(numbers[0] >= lo && numbers[0] <= hi)) {
        std::ostringstream range;
        range << key << ": " << numbers[0] << " is not in [" << lo << ", " << hi << "]";
        fail(range.str());
    }
    return numbers[0];
}

tafoni::vec3 spec::vector(std::string const& key, tafoni::vec3 const& otherwise) {
    auto const v = list(key, {otherwise[0], otherwise[1], otherwise[2]});
    if (v.size() != 3) fail(key + ": three numbers are needed");
    return {v[0], v[1], v[2]};
}

tafoni::vec3 spec::direction(std::string const& key, tafoni::vec3 const& otherwise) {
    tafoni::vec3 const v = tafoni::normalized(vector(key, otherwise));
    if (!(tafoni::length(v) > 0.5)) fail(key + ": the vector is zero");
    return v;
}

std::string spec::word(std::string const& key, std::string const& otherwise) {
    if (!has(key)) return otherwise;
    std::string joined;
    for (std::string const& piece : values_[key]) joined += (joined.empty() ? "" : ",") + piece;
    return joined;
}

void spec::done() const {
    for (auto const& [key, value] : values_) {
        if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
        std::string keys;
        for (std::string const& k : known_) keys += (keys.empty() ? "" : ", ") + k;
        fail("unknown key '" + key + "'" + (keys.empty() ? "; there are none" : "; known: " + keys));
    }
}

tafoni::vec3 parse_vector(std::string const& option, std::string const& text) {
    auto const pieces = split(text);
    tafoni::vec3 v{0, 0, 0};
    bool good = pieces.size() == 3;
    for (int a = 0; good && a < 3; ++a) good = parse_number(pieces[static_cast<std::size_t>(a)], v[a]);
    if (!good) throw usage_error(option + " " + text + ": three numbers x,y,z are needed");
    return v;
}

tafoni::vec3 parse_direction(std::string const& option, std::string const& text) {
    tafoni::vec3 const v = tafoni::normalized(parse_vector(option, text));
    if (!(tafoni::length(v) > 0.5)) throw usage_error(option + " " + text + ": the vector is zero");
    return v;
}

}  // namespace weather
