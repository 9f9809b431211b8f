// Where there is no acdf_batch.
#include <acdf/product/vectors.h>

const AcdfProductVectors* acdf_product_vectors() { return nullptr; }
