#include "tools/render/scene_json.h"

#include "tools/render/scene_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace acdf::tools {
namespace {

/// As people write it: 0.5, 1e+06.
std::string number_text(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

/// Text of the user's for a message: short, on one line.
std::string shown(const std::string& text) {
    std::string out = text.substr(0, 40);
    for (char& c : out)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
    return "'" + out + (text.size() > 40 ? "...'" : "'");
}

} // namespace

Json parse_strict(const std::string& text) {
    std::vector<std::set<std::string>> keys; // of the objects that are open
    const auto check = [&](int, Json::parse_event_t event, Json& parsed) {
        if (event == Json::parse_event_t::object_start) keys.emplace_back();
        if (event == Json::parse_event_t::object_end) keys.pop_back();
        if (event == Json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
            throw SceneError("the key " + shown(parsed.get<std::string>()) + " is given twice");
        return true;
    };
    try {
        return Json::parse(text, check);
    } catch (const Json::parse_error& error) {
        // nlohmann: "[json.exception.parse_error.101] parse error at line 1, column 5: ..."
        const std::string what = error.what();
        const std::size_t at = what.find("parse error");
        std::string line = "not JSON: " + (at == std::string::npos ? what : what.substr(at));
        for (char& c : line)
            if (static_cast<unsigned char>(c) < 0x20) c = ' ';
        throw SceneError(line.substr(0, 300));
    } catch (const Json::exception&) { // nlohmann: out_of_range
        throw SceneError("not JSON: a number is out of range");
    }
}

void JsonValue::fail(const std::string& what) const {
    throw SceneError((path_.empty() ? std::string("the scene") : path_) + ": " + what);
}

double JsonValue::number(double least, double most) const {
    if (!value_.is_number()) fail(std::string("is ") + value_.type_name() + ", not a number");
    const double value = value_.get<double>();
    if (!(value >= least && value <= most))
        fail("is " + number_text(value) + ", not from " + number_text(least) + " to " + number_text(most));
    return value;
}

std::uint32_t JsonValue::count(std::uint32_t most) const {
    const double value = number(1.0, most);
    if (value != std::floor(value)) fail("is " + number_text(value) + ", not a whole number");
    return static_cast<std::uint32_t>(value);
}

bool JsonValue::truth() const {
    if (!value_.is_boolean()) fail(std::string("is ") + value_.type_name() + ", not true or false");
    return value_.get<bool>();
}

std::string JsonValue::text() const {
    if (!value_.is_string()) fail(std::string("is ") + value_.type_name() + ", not a string");
    const auto text = value_.get<std::string>();
    if (text.empty()) fail("is empty");
    if (std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
        fail("has control characters");
    return text;
}

std::array<double, 3> JsonValue::triple(double least, double most) const {
    if (!value_.is_array() || value_.size() != 3) fail("is not an array of three numbers");
    std::array<double, 3> out{};
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = JsonValue(value_[k], path_ + "[" + std::to_string(k) + "]").number(least, most);
    return out;
}

void JsonValue::each(std::size_t most, const std::function<void(const JsonValue&)>& visit) const {
    if (!value_.is_array()) fail(std::string("is ") + value_.type_name() + ", not an array");
    if (value_.empty()) fail("is empty");
    if (value_.size() > most) fail("has more than " + std::to_string(most) + " elements");
    for (std::size_t i = 0; i < value_.size(); ++i)
        visit(JsonValue(value_[i], path_ + "[" + std::to_string(i) + "]"));
}

JsonObject::JsonObject(const JsonValue& value) : value_(value) {
    if (!value.json().is_object()) value.fail(std::string("is ") + value.json().type_name() + ", not an object");
}

bool JsonObject::has(const char* key) {
    known_.emplace_back(key);
    return value_.json().contains(key);
}

JsonValue JsonObject::at(const char* key) {
    if (!has(key)) value_.fail(std::string("lacks '") + key + "'");
    return {value_.json().at(key), value_.path().empty() ? key : value_.path() + "." + key};
}

void JsonObject::if_has(const char* key, const std::function<void(const JsonValue&)>& read) {
    if (has(key)) read(at(key));
}

void JsonObject::finish() const {
    for (const auto& item : value_.json().items())
        if (std::find(known_.begin(), known_.end(), item.key()) == known_.end())
            value_.fail("has an unknown key " + shown(item.key()));
}

} // namespace acdf::tools
