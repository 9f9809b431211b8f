// A JSON object that is read key by key, and complains of what it should not contain.
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace acdf::tools {

using Json = nlohmann::json;

/// Of strict JSON: no comments, no repeated keys. Throws SceneError.
Json parse_strict(const std::string& text);

/// A value and where it is, "objects[2].sphere".
class JsonValue {
public:
    JsonValue(const Json& value, std::string path) : value_(value), path_(std::move(path)) {}

    /// Each throws SceneError where the value is of another type or out of range.
    double number(double least, double most) const;
    std::uint32_t count(std::uint32_t most) const; ///< whole, from 1
    bool truth() const;
    std::string text() const; ///< not empty, without control characters
    std::array<double, 3> triple(double least, double most) const;
    /// Calls `visit` for the elements of an array of at most `most`.
    void each(std::size_t most, const std::function<void(const JsonValue&)>& visit) const;

    [[noreturn]] void fail(const std::string& what) const;
    const Json& json() const { return value_; }
    const std::string& path() const { return path_; }

private:
    const Json& value_;
    std::string path_;
};

/// The keys of an object: ask for each, then call finish().
class JsonObject {
public:
    /// Throws SceneError where the value is no object.
    explicit JsonObject(const JsonValue& value);

    bool has(const char* key);
    JsonValue at(const char* key); ///< throws SceneError where it is missing
    void if_has(const char* key, const std::function<void(const JsonValue&)>& read);
    /// Throws SceneError for a key that was never asked for.
    void finish() const;

private:
    JsonValue value_;
    std::vector<std::string> known_;
};

} // namespace acdf::tools
