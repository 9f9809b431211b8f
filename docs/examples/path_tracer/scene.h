// A scene in Embree: a ground, a wall with a roof, boxes and a ball. z is up.
#pragma once

#include "vector.h"

#include <embree3/rtcore.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

struct Material {
    Vec diffuse;
    float glossy = 0.0f;   ///< share of a Phong lobe
    float exponent = 0.0f; ///< of it
};

struct Hit {
    bool any = false;
    Vec point, normal; ///< towards where the ray came from
    const Material* material = nullptr;
};

class Scene {
public:
    Scene() : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        const int stone = 0, red = 1, shiny = 2; // of materials_
        quad({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, stone);
        box({-3.2f, 1.5f, 0}, {6.4f, 0.2f, 2.6f}, stone);
        box({-3.2f, -0.6f, 2.5f}, {6.4f, 2.2f, 0.15f}, stone);
        box({-2.3f, -0.6f, 0}, {0.9f, 0.9f, 1.3f}, red);
        box({1.4f, -1.8f, 0}, {1.0f, 0.7f, 0.6f}, shiny);
        ball({0.1f, -0.4f, 0.8f}, 0.8f, shiny);
        rtcCommitScene(scene_);
    }
    ~Scene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    Hit intersect(Vec from, Vec towards) const {
        RTCRayHit query = {};
        query.ray = ray(from, towards);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_, &context, &query);
        Hit hit;
        hit.any = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        if (!hit.any) return hit;
        hit.point = from + towards * query.ray.tfar;
        hit.normal = normalized({query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
        if (dot(hit.normal, towards) > 0.0f) hit.normal = hit.normal * -1.0f;
        hit.point = hit.point + hit.normal * 1e-4f;
        hit.material = &materials_[material_of_[query.hit.geomID]];
        return hit;
    }
    bool hidden(Vec from, Vec towards) const {
        RTCRay query = ray(from, towards);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(scene_, &context, &query);
        return query.tfar < 0.0f;
    }

private:
    static RTCRay ray(Vec from, Vec towards) {
        RTCRay query = {};
        query.org_x = from.x, query.org_y = from.y, query.org_z = from.z;
        query.dir_x = towards.x, query.dir_y = towards.y, query.dir_z = towards.z;
        query.tfar = std::numeric_limits<float>::infinity();
        query.mask = ~0u;
        return query;
    }
    void attach(RTCGeometry geometry, int made_of) {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry); // numbers follow each other
        rtcReleaseGeometry(geometry);
        material_of_.push_back(made_of);
    }
    void quad(Vec at, Vec a, Vec b, int made_of) {
        const Vec corners[4] = {at, at + a, at + a + b, at + b};
        const std::uint32_t one[4] = {0, 1, 2, 3};
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
        std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec), 4),
                    corners, sizeof corners);
        std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, sizeof one, 1),
                    one, sizeof one);
        attach(geometry, made_of);
    }
    void box(Vec at, Vec size, int made_of) {
        const Vec x = {size.x, 0, 0}, y = {0, size.y, 0}, z = {0, 0, size.z};
        quad(at, x, y, made_of), quad(at, x, z, made_of), quad(at, y, z, made_of);
        quad(at + x, y, z, made_of), quad(at + y, x, z, made_of), quad(at + z, x, y, made_of);
    }
    void ball(Vec middle, float radius, int made_of) {
        const float of[4] = {middle.x, middle.y, middle.z, radius};
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof of, 1),
                    of, sizeof of);
        attach(geometry, made_of);
    }

    RTCDevice device_;
    RTCScene scene_;
    Material materials_[3] = {
        {{0.6f, 0.55f, 0.5f}, 0.0f, 0.0f}, {{0.6f, 0.2f, 0.15f}, 0.0f, 0.0f}, {{0.2f, 0.25f, 0.3f}, 0.5f, 60.0f}};
    std::vector<int> material_of_;
};
