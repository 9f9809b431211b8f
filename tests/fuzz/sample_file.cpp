#include "tests/fuzz/sample_file.h"
#include "tests/lib/curves/open.h"

#include "tests/fuzz/require.h"
#if ACDF_BATCH
#include "tests/fuzz/sample_batches.h"
#endif
#include "tests/fuzz/sample_product.h"

#include "indexed/check.h"

#include <acdf/acdf.h>
#include <acdf/curves/curves.h>
#include <acdf/indexed/views.h>
#include <acdf/shader/tables.h>
#include <acdf/visibility/visibility.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace acdf_test {
namespace {

bool is_unit(const float v[3]) {
    double square = 0.0;
    for (int k = 0; k < 3; ++k) square += double{v[k]} * v[k];
    return std::fabs(square - 1.0) < 2e-6;
}
bool is_pdf(double pdf) { return pdf >= 0.0 && std::isfinite(pdf); }
bool in_unit_square(const double u[2]) { return u[0] >= 0.0 && u[0] <= 1.0 && u[1] >= 0.0 && u[1] <= 1.0; }

void sample_everything(const acdf::EnvironmentView& view, FuzzRandom& random) {
    require(view.total() > 0.0);
    for (int n = 0; n < samples_a_file; ++n) {
        const acdf::DirectionSample s = view.sample(random.any_u(), random.any_u());
        require(is_unit(s.direction) && s.pdf > 0.0f && std::isfinite(s.pdf));
        require(view.pdf(s.direction) > 0.0f); // of tilted curves it may differ by rounding
        require(!view.data().halved || view.pdf(s.direction) == s.pdf);
        double u[2];
        require(view.invert(s.direction, u) && in_unit_square(u));
        float any[3];
        random.any_vector(any);
        require(is_pdf(static_cast<double>(view.pdf(any))));
        random.unit_vector(any, false);
        require(view.invert(any, u) == (view.pdf(any) > 0.0f));
    }
#if ACDF_BATCH
    sample_batches(view, random);
#endif
}

/// The lookup grid of an environment leads where descents from the root do.
void lookups_are_descents(const acdf::EnvironmentView& view, const void* bytes, std::size_t size,
                          FuzzRandom& random) {
    acdf::LoadOptions options;
    options.tables = false;
    acdf::File plain;
    require(acdf::File::from_memory(bytes, size, plain, acdf::with_curves(options)).ok());
    const acdf::EnvironmentView descents = plain.environment();
    require(descents.data().halved->bits == 0);
    for (int n = 0; n < samples_a_file; ++n) {
        const double u0 = random.any_u(), u1 = random.any_u();
        const acdf::DirectionSample a = view.sample(u0, u1), b = descents.sample(u0, u1);
        require(std::memcmp(&a, &b, sizeof a) == 0);
        float any[3];
        if (n % 2 == 0) random.any_vector(any);
        else random.unit_vector(any, false);
        require(view.pdf(any) == descents.pdf(any));
    }
}

void sample_everything(const acdf::LocalEnvironmentView& view, FuzzRandom& random) {
    for (int n = 0; n < samples_a_file; ++n) {
        float normal[3], any[3];
        random.any_vector(normal);
        random.any_vector(any);
        const double u0 = random.any_u(), u1 = random.any_u();
        const acdf::DirectionSample s = view.sample(normal, u0, u1);
        require(is_pdf(static_cast<double>(s.pdf)) && is_pdf(view.irradiance(normal)));
        require(is_pdf(static_cast<double>(view.pdf(normal, any))));
        const AcdfLocalPoint point = view.at(normal);
        const acdf::DirectionSample again = view.sample(point, u0, u1);
        require(again.pdf == s.pdf && view.pdf(point, any) == view.pdf(normal, any));
        (void)view.stored(normal);
        if (s.pdf == 0.0f) continue;
        require(is_unit(s.direction) && view.pdf(normal, s.direction) > 0.0f);
    }
    sample_everything(view.environment(), random);
#if ACDF_BATCH
    sample_batches(view, random);
#endif
}

void sample_everything(const acdf::VisibleLocalView& view, FuzzRandom& random) {
    for (int n = 0; n < samples_a_file; ++n) {
        float normal[3], any[3], position[3];
        random.any_vector(normal);
        random.any_vector(any);
        random.any_vector(position);
        const double u0 = random.any_u(), u1 = random.any_u();
        if (n % 2 == 1 && view.has_cells()) // else hardly any lies in the cells
            for (int k = 0; k < 3; ++k) {
                const AcdfVisibility& cells = *view.data().cells.header;
                position[k] = static_cast<float>(double{cells.low[k]} +
                                                 (double{cells.high[k]} - double{cells.low[k]}) * random.uniform());
            }
        const AcdfVisiblePoint point = view.at(position, normal);
        const acdf::DirectionSample s = view.sample(point, u0, u1);
        require(is_pdf(static_cast<double>(s.pdf)) && is_pdf(static_cast<double>(view.pdf(point, any))));
        require(s.pdf == 0.0f || (is_unit(s.direction) && view.pdf(point, s.direction) > 0.0f));
    }
    sample_product(view, random);
}

void sample_everything(const acdf::BrdfView& view, FuzzRandom& random) {
    for (int n = 0; n < samples_a_file; ++n) {
        float wo[3], any[3];
        random.mostly_unit_vector(n, wo, true);
        random.any_vector(any);
        const acdf::DirectionSample s = view.sample(wo, random.any_u(), random.any_u());
        require(is_pdf(static_cast<double>(s.pdf)) && is_pdf(view.albedo(wo)));
        require(s.pdf == 0.0f || is_unit(s.direction));
        require(is_pdf(static_cast<double>(view.pdf(wo, any))));
        require(is_pdf(static_cast<double>(view.pdf(wo, s.direction))));
        double u[2];
        if (view.invert(wo, s.direction, u)) require(in_unit_square(u));
        if (view.invert(wo, any, u)) require(in_unit_square(u));
    }
#if ACDF_BATCH
    sample_batches(view, random);
#endif
}

void sample_everything(const acdf::TableView& view, FuzzRandom& random) {
    for (int n = 0; n < samples_a_file; ++n) {
        std::uint32_t index[ACDF_MAX_AXES] = {};
        double u[ACDF_MAX_AXES], x[ACDF_MAX_AXES] = {}, back[ACDF_MAX_AXES];
        for (std::uint32_t i = 0; i < view.indexed_count(); ++i)
            index[i] = random.below(view.data().axes[i].resolution + 1);
        for (double& v : u) v = random.any_u();
        const double pdf = view.sample(index, u, x);
        require(is_pdf(pdf) && (pdf > 0.0) == (view.share(index) > 0.0));
        require(view.pdf(index, x) == pdf || pdf == 0.0);
        require(view.invert(index, x, back) || pdf == 0.0);
        require(is_pdf(view.pdf(index, u)));
    }
}

/// The same bytes through the C interface: the same pdfs.
void sample_in_c(const void* bytes, std::size_t size, const acdf::File& file, FuzzRandom& random) {
    AcdfError error;
    AcdfFile* c = acdf_test::from_memory_in_c(bytes, size, &error);
    require(c && error.code == ACDF_OK && acdf_kind(c) == file.kind() && acdf_size(c) == size);
    require(acdf_metadata_count(c) == file.metadata_count());
    require(!acdf_axis(c, file.description().axis_count) && !acdf_bin(c, file.description().bin_count));
    AcdfEnvironment environment;
    AcdfLocal local;
    AcdfBrdf brdf;
    AcdfTable table;
    AcdfIndexed maps;
    const int views =
        acdf_environment(c, &environment) + acdf_local(c, &local) + acdf_brdf(c, &brdf) + acdf_table(c, &table);
    acdf::IndexedEnvironment in_cpp;
    require(acdf_indexed(c, &maps, &error) == acdf::IndexedEnvironment::open(file, in_cpp).ok());
    require(maps.tables.bytes == in_cpp.table_bytes() && (error.code == ACDF_OK) == !in_cpp.empty());
    require(views == (file.kind() != ACDF_KIND_INDEXED));
    acdf_indexed_close(&maps);
    float v[3], wi[3];
    random.unit_vector(v, true);
    random.unit_vector(wi, false);
    if (file.kind() == ACDF_KIND_ENVIRONMENT)
        require(acdf_environment_pdf(&environment, wi) == file.environment().pdf(wi));
    if (file.kind() == ACDF_KIND_LOCAL) require(acdf_local_pdf(&local, v, wi) == file.local().pdf(v, wi));
    if (file.kind() == ACDF_KIND_BRDF) require(acdf_brdf_pdf(&brdf, v, wi) == file.brdf().pdf(v, wi));
    acdf_close(c);
}

/// As shaders do. What is made for a BRDF answers as one, too, of the words of any other file.
void sample_brdf_walk(const acdf::ShaderTables& tables, bool brdf, FuzzRandom& random) {
    for (int n = 0; n < samples_a_file; ++n) {
        float wo[3], any[3];
        random.mostly_unit_vector(n, wo, true);
        random.any_vector(any);
        const std::uint32_t* words = tables.words();
        const AcdfShaderView view = acdf_brdf_view_of(words, wo[0], wo[1], wo[2]);
        const auto n0 = static_cast<std::uint32_t>(random.next()), n1 = static_cast<std::uint32_t>(random.next());
        const AcdfWalkSample s = acdf_brdf_walk_sample(words, view, n0, n1);
        require(std::isfinite(acdf_brdf_walk_pdf(words, view, any[0], any[1], any[2])));
        require(std::isfinite(s.pdf) && s.pdf >= 0.0f && (brdf || s.pdf == 0.0f));
        if (s.pdf == 0.0f) continue;
        const float own = acdf_brdf_walk_pdf(words, view, s.x, s.y, s.z); // wi is as long as wo
        require(own == s.pdf || (own == 0.0f && s.pdf < 1.2e-38f));
    }
}

/// What is made for several maps answers as them; the words of any other file say that there are none.
void sample_sky_walk(const acdf::ShaderTables& tables, bool maps, FuzzRandom& random) {
    const std::uint32_t* words = tables.words();
    for (int n = 0; n < samples_a_file; ++n) {
        float at[3], any[3];
        random.any_vector(at);
        random.any_vector(any);
        const AcdfShaderSky sky = acdf_sky_at(words, at[0], at[1], at[2]);
        const auto n0 = static_cast<std::uint32_t>(random.next()), n1 = static_cast<std::uint32_t>(random.next());
        const AcdfWalkSample s = acdf_sky_sample(words, sky, n0, n1);
        require(std::isfinite(s.pdf) && s.pdf >= 0.0f && (maps || s.pdf == 0.0f));
        require(std::isfinite(acdf_sky_pdf(words, sky, any[0], any[1], any[2])));
        const float d[3] = {s.x, s.y, s.z};
        if (s.pdf > 0.0f) require(is_unit(d) && acdf_sky_pdf(words, sky, s.x, s.y, s.z) == s.pdf);
    }
}

/// As shaders do, of whatever files have tables for them.
void sample_walk(const acdf::File& file, FuzzRandom& random) {
    acdf::ShaderTables tables;
    if (!acdf::ShaderTables::make(file, tables).ok()) return;
    for (int n = 0; n < samples_a_file; ++n) {
        float normal[3], any[3];
        random.any_vector(normal);
        random.any_vector(any);
        const std::uint32_t* words = tables.words();
        const AcdfShaderPoint point = acdf_point_at(words, normal[0], normal[1], normal[2]);
        const auto n0 = static_cast<std::uint32_t>(random.next()), n1 = static_cast<std::uint32_t>(random.next());
        const AcdfWalkSample s = acdf_walk_sample(words, point, n0, n1);
        require(std::isfinite(acdf_walk_pdf(words, point, any[0], any[1], any[2])));
        require(std::isfinite(s.pdf) && s.pdf >= 0.0f);
        if (s.pdf == 0.0f) continue;
        const float d[3] = {s.x, s.y, s.z};
        require(is_unit(d) && acdf_walk_pdf(words, point, s.x, s.y, s.z) == s.pdf);
    }
    sample_brdf_walk(tables, file.kind() == ACDF_KIND_BRDF, random);
    sample_sky_walk(tables, file.kind() == ACDF_KIND_INDEXED, random);
}

/// What the rules of maps refuse has none; `validate_maps` agrees.
void sample_maps(const acdf::File& file, FuzzRandom& random) {
    acdf::IndexedEnvironment maps;
    const acdf::Status status = acdf::IndexedEnvironment::open(file, maps);
    const auto ignore = [](const acdf::Finding&, void*) { return true; };
    require(acdf::validate_maps(file, ignore, nullptr).valid() == status.ok() && maps.empty() == !status.ok());
    require(status.ok() || (status.rule != 0 && status.message[0] != 0 && status.offset <= file.size()));
    if (!status.ok()) return;
    for (int n = 0; n < 4; ++n) {
        const AcdfIndexed& data = maps.data();
        double at[3];
        const double* of_axis = data.coordinates;
        for (std::uint32_t axis = 0; axis < data.axes; of_axis += data.counts[axis++])
            at[axis] = of_axis[0] + (of_axis[data.counts[axis] - 1] - of_axis[0]) * random.uniform();
        const acdf::MixedEnvironment sky = maps.at(at);
        for (int i = 0; i < samples_a_file / 4; ++i) {
            const acdf::DirectionSample s = sky.sample(random.any_u(), random.any_u());
            float any[3];
            double u[2];
            random.any_vector(any);
            require(is_pdf(static_cast<double>(sky.pdf(any))));
            require(is_unit(s.direction) && s.pdf > 0.0f && std::isfinite(s.pdf) && sky.pdf(s.direction) == s.pdf);
            require(sky.invert(s.direction, u) && in_unit_square(u));
        }
    }
}

} // namespace

void sample_everything(const acdf::File& file, const void* bytes, std::size_t size) {
    FuzzRandom random(size);
    acdf::Text key, value;
    for (std::uint32_t i = 0; i < file.metadata_count() && i < 16; ++i) {
        file.metadata(i, key, value);
        require(key.size != 0 && (value.data || value.size == 0));
    }
    if (file.kind() == ACDF_KIND_ENVIRONMENT) sample_everything(file.environment(), random);
    if (file.kind() == ACDF_KIND_ENVIRONMENT && file.environment().data().halved &&
        file.header().header_crc % 2 == 1)
        lookups_are_descents(file.environment(), bytes, size, random);
    if (file.kind() == ACDF_KIND_LOCAL) sample_everything(file.local(), random);
    acdf::VisibleLocalView visible;
    require(file.kind() == ACDF_KIND_LOCAL || !acdf::VisibleLocalView::of(file, visible).ok());
    if (file.kind() == ACDF_KIND_LOCAL && acdf::VisibleLocalView::of(file, visible).ok())
        sample_everything(visible, random);
    if (file.kind() == ACDF_KIND_BRDF) sample_everything(file.brdf(), random);
    if (file.kind() == ACDF_KIND_TABLE) sample_everything(file.table(), random);
    if (file.kind() == ACDF_KIND_INDEXED) sample_maps(file, random);
    if (file.header().header_crc % 4 == 1) sample_walk(file, random);
    if (size % 8 == 0 && file.header().header_crc % 8 == 0) sample_in_c(bytes, size, file, random); // loads again
}

} // namespace acdf_test
