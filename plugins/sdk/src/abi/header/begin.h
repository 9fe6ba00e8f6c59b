/* Luxel's plugin boundary in C. Made from the Rust types: do not edit.
 *
 * A plugin is a struct of its parameters at one point, and a table of functions that take the
 * address of such a struct first. The host writes the struct's fields as the schema says; textures
 * and wavelengths have been looked up when a function is called. Functions write what they find to
 * `out` and return LUXEL_OK, or LUXEL_NOTHING where there is nothing. They are called from several
 * threads at once. Memory that is lent is lent for the call.
 */
#ifndef LUXEL_H
#define LUXEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef _WIN32
#define LUXEL_EXPORT __declspec(dllexport)
#else
#define LUXEL_EXPORT __attribute__((visibility("default")))
#endif
#define LUXEL_CHECK(holds, what) _Static_assert(holds, "differs from the host: " what)

typedef uint32_t luxel_status;
#define LUXEL_OK 0u
#define LUXEL_NOTHING 1u
#define LUXEL_PANICKED 2u
#define LUXEL_REFUSED 3u

typedef struct { float x, y; } luxel_vec2;
typedef struct { float x, y, z; } luxel_vec3;
typedef struct { double x, y; } luxel_dvec2;
typedef struct { double x, y, z; } luxel_dvec3;
typedef struct { uint32_t x, y; } luxel_uvec2;
/* Four lanes: linear sRGB in the first three, or four wavelengths. A plugin cannot tell which. */
typedef struct { _Alignas(16) float lanes[4]; } luxel_spectrum;

typedef struct { const char *ptr; size_t len; } luxel_text;
typedef struct { const uint8_t *items; size_t len; } luxel_bytes;
typedef struct { const uint32_t *items; size_t len; } luxel_u32s;
typedef struct { const double *items; size_t len; } luxel_doubles;
typedef struct { const luxel_vec2 *items; size_t len; } luxel_vec2s;
typedef struct { const luxel_vec3 *items; size_t len; } luxel_vec3s;
typedef struct { const uint32_t (*items)[3]; size_t len; } luxel_triangles_of;
typedef struct { const luxel_text *items; size_t len; } luxel_texts;
typedef struct { bool given; float value; } luxel_maybe_float;
typedef struct { bool given; double value; } luxel_maybe_double;
#define LUXEL_TEXT(literal) { literal, sizeof(literal) - 1 }

