// acdf_clear_sky WIDTH HOUR TURBIDITY OUT.pfm [LATITUDE DECLINATION]: a clear sky as a lat-long map (clear_sky.h),
// by default at 45 degrees north on the longest day. LATITUDE and DECLINATION are in degrees, HOUR is solar time.
#include "clear_sky.h"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    if (argc != 5 && argc != 7)
        return std::fprintf(stderr, "acdf_clear_sky WIDTH HOUR TURBIDITY OUT.pfm [LATITUDE DECLINATION]\n"), 2;
    const int width = std::atoi(argv[1]);
    if (width < 2 || width % 2 != 0) return std::fprintf(stderr, "acdf_clear_sky: WIDTH is an even number\n"), 2;
    const double latitude = argc == 7 ? std::atof(argv[5]) : 45.0,
                 declination = argc == 7 ? std::atof(argv[6]) : 23.44;
    const clear_sky::Sky sky(clear_sky::sun_at(std::atof(argv[2]), latitude, declination), std::atof(argv[3]));
    const std::vector<float> rgb = clear_sky::latlong(sky, width);
    std::FILE* file = std::fopen(argv[4], "wb");
    if (!file) return std::perror(argv[4]), 1;
    std::fprintf(file, "PF\n%d %d\n-1.0\n", width, width / 2); // rows from the bottom, little-endian
    bool written = true;
    for (int row = width / 2; row-- > 0;)
        written = std::fwrite(&rgb[std::size_t{3} * row * width], 12, width, file) == std::size_t(width) && written;
    return std::fclose(file) == 0 && written ? 0 : (std::perror(argv[4]), 1);
}
