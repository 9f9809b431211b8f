#pragma once

#include <acdf/product/product.h>
#include <acdf/visibility/visibility.h>

#include <cstdint>

namespace acdf_cuda {

struct Question {
    double u[ACDF_MAX_AXES];
    double x[ACDF_MAX_AXES]; ///< a point of a table
    float direction[3], normal[3], view[3], position[3];
};

struct Answer {
    double place[ACDF_MAX_AXES]; ///< what is sampled: a direction, or a point of a table
    double density;              ///< of the sample
    double again;                ///< of its direction
    double other;                ///< of the question's direction
};

ACDF_METHOD inline Answer answer(const acdf::DirectionSample& sampled, float again, float other) {
    Answer out = {};
    for (int k = 0; k < 3; ++k) out.place[k] = double{sampled.direction[k]};
    out.density = double{sampled.pdf};
    out.again = double{again};
    out.other = double{other};
    return out;
}

struct OfEnvironment {
    acdf::EnvironmentView view;
    ACDF_METHOD Answer operator()(const Question& q) const {
        const acdf::DirectionSample s = view.sample(q.u[0], q.u[1]);
        return answer(s, view.pdf(s.direction), view.pdf(q.direction));
    }
};

struct OfLocal {
    acdf::VisibleLocalView view;
    ACDF_METHOD Answer operator()(const Question& q) const {
        const AcdfVisiblePoint point = view.at(q.position, q.normal);
        const acdf::DirectionSample s = view.sample(point, q.u[0], q.u[1]);
        return answer(s, view.pdf(point, s.direction), view.pdf(point, q.direction));
    }
};

struct OfBrdf {
    acdf::BrdfView view;
    ACDF_METHOD Answer operator()(const Question& q) const {
        const acdf::DirectionSample s = view.sample(q.view, q.u[0], q.u[1]);
        return answer(s, view.pdf(q.view, s.direction), view.pdf(q.view, q.direction));
    }
};

/// A local environment times a BRDF; `view` is in the frame of directions.
struct OfProduct {
    acdf::LocalEnvironmentView light;
    acdf::BrdfView surface;
    int parts;
    ACDF_METHOD Answer operator()(const Question& q) const {
        const acdf::ProductSampler<acdf::BrdfLobe> product(light.data(), acdf::BrdfLobe(surface.data()), {parts});
        const auto point = product.at(q.normal, q.view);
        const acdf::DirectionSample s = product.sample(point, q.u[0], q.u[1]);
        return answer(s, product.pdf(point, s.direction), product.pdf(point, q.direction));
    }
};

/// Bin 0 of a table.
struct OfTable {
    acdf::TableView view;
    ACDF_METHOD Answer operator()(const Question& q) const {
        const std::uint32_t index[ACDF_MAX_AXES] = {};
        Answer out = {};
        out.density = view.sample(index, q.u, out.place);
        out.again = view.pdf(index, out.place);
        out.other = view.pdf(index, q.x);
        return out;
    }
};

} // namespace acdf_cuda
