/* Words of acdf/shader/dialect.h that languages share which declare as C does: all but WGSL. A dialect says what
 * functions begin with, ACDF_DIALECT_FN. */
#ifndef ACDF_DIALECT_WORDS_H
#define ACDF_DIALECT_WORDS_H

#define ACDF_FN1(result, name, t0, p0) ACDF_DIALECT_FN result name(t0 p0)
#define ACDF_FN2(result, name, t0, p0, t1, p1) ACDF_DIALECT_FN result name(t0 p0, t1 p1)
#define ACDF_FN3(result, name, t0, p0, t1, p1, t2, p2) ACDF_DIALECT_FN result name(t0 p0, t1 p1, t2 p2)
#define ACDF_FN4(result, name, t0, p0, t1, p1, t2, p2, t3, p3)                                                     \
    ACDF_DIALECT_FN result name(t0 p0, t1 p1, t2 p2, t3 p3)
#define ACDF_FN5(result, name, t0, p0, t1, p1, t2, p2, t3, p3, t4, p4)                                             \
    ACDF_DIALECT_FN result name(t0 p0, t1 p1, t2 p2, t3 p3, t4 p4)
#define ACDF_VAR(type, name) type name
#define ACDF_FIELD(type, name) type name;
#define ACDF_SELECT(condition, yes, no) ((condition) ? (yes) : (no))

#endif
