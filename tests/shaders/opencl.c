/* The exported C as OpenCL: answers to words.bin, directions.bin and normals.bin in FOLDER by the first device
 * there is. A second argument "BRDF": those of a BRDF, whose normals are views; "MAPS": those of several maps,
 * whose normals are coordinates. */
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char kernel_source[] =
    "#ifdef BRDF\n"
    "#define AT acdf_view(tables, normals[i].x, normals[i].y, normals[i].z),\n"
    "#define acdf_sample acdf_sample_brdf\n"
    "#define acdf_pdf acdf_pdf_brdf\n"
    "#elif defined(MAPS)\n"
    "#define AT acdf_sky(tables, normals[i].x, normals[i].y, normals[i].z),\n"
    "#define acdf_sample acdf_sample_sky\n"
    "#define acdf_pdf acdf_pdf_sky\n"
    "#else\n"
    "#define AT acdf_at(tables, normals[i].x, normals[i].y, normals[i].z),\n"
    "#endif\n"
    "__kernel void answer(__global const uint* tables, __global const uint2* words,\n"
    "        __global const float4* directions, __global const float4* normals, __global float4* samples,\n"
    "        __global float2* densities) {\n"
    "    const size_t i = get_global_id(0);\n"
    "    const AcdfWalkSample s = acdf_sample(tables, AT words[i].x, words[i].y);\n"
    "    const float4 d = directions[i];\n"
    "    samples[i] = (float4)(s.x, s.y, s.z, s.pdf);\n"
    "    densities[i] = (float2)(acdf_pdf(tables, AT d.x, d.y, d.z),\n"
    "                            acdf_pdf(tables, AT s.x, s.y, s.z));\n"
    "}\n";

static char* read_file(const char* folder, const char* name, size_t* size) {
    char path[4096];
    char* bytes;
    FILE* file;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0) exit(1);
    *size = (size_t)ftell(file);
    rewind(file);
    bytes = (char*)malloc(*size + 1);
    if (!bytes || fread(bytes, 1, *size, file) != *size) exit(1);
    bytes[*size] = 0;
    fclose(file);
    return bytes;
}

static void require(cl_int error, const char* what) {
    if (error == CL_SUCCESS) return;
    fprintf(stderr, "OpenCL: %s: error %d\n", what, (int)error);
    exit(1);
}

static void write_buffer(cl_command_queue queue, cl_mem buffer, size_t size, const char* folder, const char* name) {
    char path[4096];
    void* bytes = malloc(size);
    FILE* file;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    require(clEnqueueReadBuffer(queue, buffer, CL_TRUE, 0, size, bytes, 0, NULL, NULL), "read");
    file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file)) exit(1);
    free(bytes);
}

int main(int argc, char** argv) {
    const char* folder = argc > 1 ? argv[1] : ".";
    const char* names[4] = {"tables.bin", "words.bin", "directions.bin", "normals.bin"};
    const char* sources[2];
    char options[128] = "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt";
    char* exported;
    size_t size = 0, count = 0;
    cl_platform_id platform;
    cl_device_id device;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
    cl_kernel kernel;
    cl_mem buffers[6];
    cl_uint i;
    cl_int error;
    if (argc > 2) strcat(strcat(options, " -D"), argv[2]);
    if (clGetPlatformIDs(1, &platform, NULL) != CL_SUCCESS ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, NULL) != CL_SUCCESS) {
        fprintf(stderr, "skipped: there is no OpenCL device (pocl-opencl-icd makes one of the processor)\n");
        return 77;
    }
    context = clCreateContext(NULL, 1, &device, NULL, NULL, &error);
    require(error, "context");
    queue = clCreateCommandQueue(context, device, 0, &error);
    require(error, "queue");
    exported = read_file(folder, "exported.h", &size);
    sources[0] = exported;
    sources[1] = kernel_source;
    program = clCreateProgramWithSource(context, 2, sources, NULL, &error);
    require(error, "program");
    if (clBuildProgram(program, 1, &device, options, NULL, NULL) != CL_SUCCESS) {
        char log[8192] = "";
        clGetProgramBuildInfo(program, device, CL_PROGRAM_BUILD_LOG, sizeof log, log, NULL);
        fprintf(stderr, "%s\n", log);
        return 1;
    }
    kernel = clCreateKernel(program, "answer", &error);
    require(error, "kernel");
    for (i = 0; i < 4; ++i) {
        char* bytes = read_file(folder, names[i], &size);
        buffers[i] = clCreateBuffer(context, CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, size, bytes, &error);
        require(error, names[i]);
        free(bytes);
    }
    count = size / 16;
    buffers[4] = clCreateBuffer(context, CL_MEM_WRITE_ONLY, 16 * count, NULL, &error);
    require(error, "draws");
    buffers[5] = clCreateBuffer(context, CL_MEM_WRITE_ONLY, 8 * count, NULL, &error);
    require(error, "densities");
    for (i = 0; i < 6; ++i) require(clSetKernelArg(kernel, i, sizeof(cl_mem), &buffers[i]), "argument");
    require(clEnqueueNDRangeKernel(queue, kernel, 1, NULL, &count, NULL, 0, NULL, NULL), "run");
    write_buffer(queue, buffers[4], 16 * count, folder, "samples.bin");
    write_buffer(queue, buffers[5], 8 * count, folder, "densities.bin");
    return 0;
}
