/* The exported C on this processor: answers to words.bin, directions.bin and normals.bin (BRDF: which are views;
 * MAPS: coordinates) in FOLDER. TABLES_FILE: by tables.bin, else by those in the header. */
#include "exported.h"

#ifdef BRDF
#define AT acdf_view
#define POINT AcdfShaderView
#define SAMPLE acdf_sample_brdf
#define PDF acdf_pdf_brdf
#elif defined(MAPS)
#define AT acdf_sky
#define POINT AcdfShaderSky
#define SAMPLE acdf_sample_sky
#define PDF acdf_pdf_sky
#else
#define AT acdf_at
#define POINT AcdfShaderPoint
#define SAMPLE acdf_sample
#define PDF acdf_pdf
#endif

#include <stdio.h>
#include <stdlib.h>

static void* read_file(const char* folder, const char* name, size_t* size) {
    char path[4096];
    FILE* file;
    void* bytes;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0) exit(1);
    *size = (size_t)ftell(file);
    rewind(file);
    bytes = malloc(*size + 1);
    if (!bytes || fread(bytes, 1, *size, file) != *size) exit(1);
    fclose(file);
    return bytes;
}

int main(int argc, char** argv) {
    size_t size, i, count;
    const char* folder = argc > 1 ? argv[1] : ".";
    const uint32_t* words = (const uint32_t*)read_file(folder, "words.bin", &size);
    const float* directions = (const float*)read_file(folder, "directions.bin", &size);
    const float* normals = (const float*)read_file(folder, "normals.bin", &size);
    char path[4096];
    FILE *draws, *densities;
#ifdef TABLES_FILE
    const uint32_t* tables = (const uint32_t*)read_file(folder, "tables.bin", &count);
#else
    const uint32_t* tables = acdf_tables;
#endif
    count = size / (4 * sizeof(float));
    snprintf(path, sizeof path, "%s/samples.bin", folder);
    draws = fopen(path, "wb");
    snprintf(path, sizeof path, "%s/densities.bin", folder);
    densities = fopen(path, "wb");
    if (!draws || !densities) return 1;
    for (i = 0; i < count; ++i) {
        const float* d = directions + 4 * i;
        const float* n = normals + 4 * i;
        const POINT at = AT(tables, n[0], n[1], n[2]);
        const AcdfWalkSample s = SAMPLE(tables, at, words[2 * i], words[2 * i + 1]);
        const float two[2] = {PDF(tables, at, d[0], d[1], d[2]), PDF(tables, at, s.x, s.y, s.z)};
        const float four[4] = {s.x, s.y, s.z, s.pdf};
        fwrite(four, sizeof four, 1, draws);
        fwrite(two, sizeof two, 1, densities);
    }
    return fclose(draws) != 0 || fclose(densities) != 0;
}
