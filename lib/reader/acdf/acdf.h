/* The C interface of the reader: open a file here, then sample and evaluate with the inline functions of
 * acdf/sample.h, local.h, brdf.h and table.h. Languages without a C compiler can call those of
 * acdf/arrays/arrays.h, of a library beside this one. Others make views of environments of several maps
 * (acdf/indexed/open.h) and of visibility cells (acdf/visibility/visibility_c.h).
 *
 *   AcdfError error;
 *   AcdfFile* file = acdf_open("probe.acdf", &error);
 *   AcdfEnvironment sky;
 *   if (!file || !acdf_environment(file, &sky)) { ... error.message ... }
 *   AcdfDirectionSample s = acdf_environment_sample(&sky, u0, u1);   // s.direction, s.pdf in sr^-1
 *   float p = acdf_environment_pdf(&sky, s.direction);
 *   acdf_close(file);                                                // `sky` ends with it
 */
#ifndef ACDF_ACDF_H
#define ACDF_ACDF_H

#include <acdf/file.h>
#include <acdf/sample.h>
#ifndef ACDF_ENVIRONMENT_ONLY
#include <acdf/brdf.h>
#include <acdf/local.h>
#include <acdf/moved.h>
#include <acdf/table.h>
#endif

#endif
