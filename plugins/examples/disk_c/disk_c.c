/* A Luxel plugin library in C: the shape `disk_c` and the material `velvet_c`.
 *
 *     cc -std=c11 -shared -fPIC -O2 -I plugins/sdk/include -o libdisk_c.so disk_c.c -lm
 *
 * The file's stem and the table's symbol at the end belong together. Every function may be called
 * from several threads at once: it reads its struct and writes to `out`, nothing else.
 */
#include "luxel.h"

#include <float.h>
#include <math.h>

static const double PI = 3.14159265358979323846;
#define TAU 6.28318530717958647692

/* ---- Vectors ---- */

static luxel_dvec3 vec(double x, double y, double z) { return (luxel_dvec3){x, y, z}; }
static luxel_dvec3 scaled(luxel_dvec3 a, double s) { return vec(a.x * s, a.y * s, a.z * s); }
static luxel_dvec3 plus(luxel_dvec3 a, luxel_dvec3 b) { return vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static luxel_dvec3 minus(luxel_dvec3 a, luxel_dvec3 b) { return plus(a, scaled(b, -1.0)); }
static double dot(luxel_dvec3 a, luxel_dvec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static luxel_dvec3 cross(luxel_dvec3 a, luxel_dvec3 b) {
    return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static double largest(luxel_dvec3 a) { return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z))); }

/* Of unit length; `a` has a direction. Divided first, so that no square overflows or vanishes. */
static luxel_dvec3 unit(luxel_dvec3 a) {
    double m = largest(a);
    luxel_dvec3 b = vec(a.x / m, a.y / m, a.z / m);
    return scaled(b, 1.0 / sqrt(dot(b, b)));
}

/* Bound on the relative error of n chained roundings (PBR4, eq. 6.16). */
static double gamma_of(int n) {
    double e = n * (0.5 * DBL_EPSILON);
    return e / (1.0 - e);
}

/* ---- The shape: a disk, a ring, or a piece of either ---- */

typedef struct {
    luxel_dvec3 center;
    luxel_dvec3 normal;
    luxel_dvec3 start;
    double radius;
    double inner_radius;
    double sweep;
    /* Derived: a right-handed frame, and the error of a point. */
    luxel_dvec3 x, y, z;
    luxel_dvec3 p_err;
} disk;

/* What of `a` lies across the unit vector `z`. Taken off twice: after the second time nothing is
   left of the rounding that cancellation leaves after the first (Giraud et al. 2005). */
static luxel_dvec3 across(luxel_dvec3 a, luxel_dvec3 z) {
    a = minus(a, scaled(z, dot(z, a)));
    if (largest(a) > 0.0) a = unit(a);
    return minus(a, scaled(z, dot(z, a)));
}

static luxel_status disk_prepare(void *at) {
    disk *d = at;
    d->z = unit(d->normal);
    /* Where `start` points along the normal, the axis that it points along least takes its place. */
    luxel_dvec3 start = d->start, z = vec(fabs(d->z.x), fabs(d->z.y), fabs(d->z.z));
    double m = largest(start);
    start = m > 0.0 && isfinite(m) ? unit(start) : d->z;
    if (largest(minus(start, scaled(d->z, dot(d->z, start)))) < 1e-6) {
        bool x = z.x <= z.y && z.x <= z.z, y = z.y <= z.z;
        start = x ? vec(1, 0, 0) : y ? vec(0, 1, 0) : vec(0, 0, 1);
    }
    d->x = unit(across(start, d->z));
    d->y = cross(d->z, d->x);
    /* A point is c + (x a + y b): two products and two sums, and a rounding of the frame. Along the
       normal it is off by what the frame is not orthogonal, about eight roundings for each axis. */
    double r = d->radius, plane = gamma_of(5), off = r * gamma_of(16);
    d->p_err = vec((fabs(d->center.x) + (fabs(d->x.x) + fabs(d->y.x)) * r) * plane + z.x * off,
                   (fabs(d->center.y) + (fabs(d->x.y) + fabs(d->y.y)) * r) * plane + z.y * off,
                   (fabs(d->center.z) + (fabs(d->x.z) + fabs(d->y.z)) * r) * plane + z.z * off);
    return LUXEL_OK;
}

static void refuse(const luxel_fault_sink *faults, luxel_text field, luxel_text message) {
    luxel_text code = LUXEL_TEXT("E0405");
    faults->take(faults->owner, field, code, message);
}

static luxel_status disk_check(const void *at, const luxel_fault_sink *faults) {
    const disk *d = at;
    luxel_status status = LUXEL_OK;
    double m = largest(d->normal);
    if (!(m > 0.0 && isfinite(m))) {
        luxel_text field = LUXEL_TEXT("normal"), message = LUXEL_TEXT("it has no direction");
        refuse(faults, field, message);
        status = LUXEL_REFUSED;
    }
    if (!(d->inner_radius < d->radius)) {
        luxel_text field = LUXEL_TEXT("inner_radius");
        luxel_text message = LUXEL_TEXT("it leaves nothing of the disk: less than `radius` is left");
        refuse(faults, field, message);
        status = LUXEL_REFUSED;
    }
    return status;
}

/* The angle of a point of the plane from `start`, in [0, 2 pi]. */
static double turned(double x, double y) {
    double angle = atan2(y, x);
    return angle < 0.0 ? angle + TAU : angle;
}

static bool is_swept(const disk *d, double x, double y) {
    return d->sweep >= TAU || turned(x, y) <= d->sweep;
}

/* How far the piece reaches along an axis of the world, on which x and y have these parts. */
static double reach(const disk *d, double x, double y) {
    if (is_swept(d, x, y)) return d->radius * sqrt(x * x + y * y);
    double end = x * cos(d->sweep) + y * sin(d->sweep);
    double most = fmax(x, end);
    return most * (most > 0.0 ? d->radius : d->inner_radius);
}

static luxel_status disk_bounds(const void *at, luxel_bounds *out) {
    const disk *d = at;
    luxel_dvec3 c = d->center, x = d->x, y = d->y;
    /* What rounding may do to the reach: an angle, its sine, a product and a sum. */
    double far = fmax(largest(c), d->radius) * gamma_of(32);
    luxel_dvec3 room = plus(d->p_err, vec(far, far, far));
    out->max = plus(c, vec(reach(d, x.x, y.x), reach(d, x.y, y.y), reach(d, x.z, y.z)));
    out->min = minus(c, vec(reach(d, -x.x, -y.x), reach(d, -x.y, -y.y), reach(d, -x.z, -y.z)));
    out->max = plus(out->max, room);
    out->min = minus(out->min, room);
    return LUXEL_OK;
}

static luxel_status disk_intersect(const void *at, const luxel_ray *ray, luxel_hit *out) {
    const disk *d = at;
    luxel_dvec3 to = minus(d->center, ray->o);
    double t = dot(d->z, to) / dot(d->z, ray->d);
    if (!(t > 0.0 && t <= ray->t_max)) return LUXEL_NOTHING;
    /* A t that is infinite makes coordinates that are NaN or infinite, and these lie nowhere. */
    luxel_dvec3 q = minus(scaled(ray->d, t), to);
    double x = dot(d->x, q), y = dot(d->y, q), r2 = x * x + y * y;
    bool inside = r2 <= d->radius * d->radius && r2 >= d->inner_radius * d->inner_radius;
    if (!inside || !is_swept(d, x, y)) return LUXEL_NOTHING;
    *out = (luxel_hit){t, {x, y}, 0};
    return LUXEL_OK;
}

static luxel_surface surface_at(const disk *d, double x, double y) {
    double across = 2.0 * d->radius;
    return (luxel_surface){
        .p = plus(d->center, plus(scaled(d->x, x), scaled(d->y, y))),
        .p_err = d->p_err,
        .ng = d->z,
        .ns = d->z,
        .uv = {x / across + 0.5, y / across + 0.5},
        .dp_du = scaled(d->x, across),
        .dp_dv = scaled(d->y, across),
    };
}

static luxel_status disk_surface(const void *at, const luxel_ray *ray, const luxel_hit *hit,
                                 luxel_surface *out) {
    (void)ray;
    *out = surface_at(at, hit->at.x, hit->at.y);
    return LUXEL_OK;
}

static double area_of(const disk *d) {
    return 0.5 * d->sweep * (d->radius - d->inner_radius) * (d->radius + d->inner_radius);
}

static luxel_status disk_area(const void *at, double *out) {
    *out = area_of(at);
    return LUXEL_OK;
}

/* Uniform in area: the angle is, and the square of the distance (PBR4, A.5.1). */
static luxel_status disk_sample(const void *at, const luxel_dvec3 *from, const float (*u)[2],
                                luxel_shape_sample *out) {
    const disk *d = at;
    double outer2 = d->radius * d->radius, inner2 = d->inner_radius * d->inner_radius;
    double part = (*u)[0], turn = (*u)[1], density = 1.0 / area_of(d);
    (void)from;
    if (!(part >= 0.0 && part < 1.0 && turn >= 0.0 && turn < 1.0)) return LUXEL_NOTHING;
    /* The area of the least disks is 0 in double precision. */
    if (!isfinite(density)) return LUXEL_NOTHING;
    double r = sqrt(inner2 + (outer2 - inner2) * part), angle = d->sweep * turn;
    *out = (luxel_shape_sample){surface_at(d, r * cos(angle), r * sin(angle)), density};
    return LUXEL_OK;
}

static luxel_status disk_pdf(const void *at, const luxel_dvec3 *from, const luxel_surface *point,
                             double *out) {
    double density = 1.0 / area_of(at);
    (void)from, (void)point;
    *out = isfinite(density) ? density : 0.0;
    return LUXEL_OK;
}

/* `is_closed` and `mesh` are left null: the host takes their defaults, an open surface that meets
   rays itself. */
static const luxel_shape_table DISK = {
    .size = sizeof(luxel_shape_table),
    .bounds = disk_bounds,
    .intersect = disk_intersect,
    .surface = disk_surface,
    .area = disk_area,
    .sample = disk_sample,
    .pdf = disk_pdf,
};

/* Longest length whose square, times that of a far point, is still a number. */
#define LONGEST 1e75

#define LENGTH_RANGE .unit = LUXEL_TEXT("m"), .min = 0.0, .max = LONGEST
#define NO_RANGE .min = -INFINITY, .max = INFINITY
#define AT(type, field) .offset = offsetof(type, field)

static const luxel_param DISK_PARAMS[] = {
    {.name = LUXEL_TEXT("center"), .doc = LUXEL_TEXT("The middle."), .unit = LUXEL_TEXT("m"),
     .ty = LUXEL_TYPE_DVEC3, .preset = 1, .min = -LONGEST, .max = LONGEST, AT(disk, center)},
    {.name = LUXEL_TEXT("normal"), .doc = LUXEL_TEXT("Where it faces; any length above 0."),
     .ty = LUXEL_TYPE_DVEC3, .preset = 1, .numbers = {0, 1, 0}, NO_RANGE, AT(disk, normal)},
    {.name = LUXEL_TEXT("start"),
     .doc = LUXEL_TEXT("Where a piece begins, as seen from the middle; u grows that way. "
                       "Along `normal` it chooses for itself."),
     .ty = LUXEL_TYPE_DVEC3, .preset = 1, .numbers = {1, 0, 0}, NO_RANGE, AT(disk, start)},
    {.name = LUXEL_TEXT("radius"), .doc = LUXEL_TEXT("From the middle to the rim."),
     .ty = LUXEL_TYPE_DOUBLE, .flags = 1, .unit = LUXEL_TEXT("m"), .min = DBL_MIN, .max = LONGEST,
     AT(disk, radius)},
    {.name = LUXEL_TEXT("inner_radius"), .doc = LUXEL_TEXT("Radius of the hole; less than `radius`."),
     .ty = LUXEL_TYPE_DOUBLE, .preset = 1, LENGTH_RANGE, AT(disk, inner_radius)},
    {.name = LUXEL_TEXT("sweep"), .doc = LUXEL_TEXT("How far around the piece goes, against the clock."),
     .ty = LUXEL_TYPE_DOUBLE, .preset = 1, .numbers = {TAU}, .unit = LUXEL_TEXT("rad"),
     .min = 1e-3, .max = TAU, AT(disk, sweep)},
};

/* ---- The material: cloth that is bright where it is seen from the side ---- */

typedef struct {
    luxel_spectrum reflectance;
    float sheen;
} velvet;

/* How much each of two lobes reflects of what comes from `wo`: a matt one, and one of fibres that
   stand upright, with f = 3 (1 - cos_i)(1 - cos_o) / pi. The second reflects 1 - cos_o: nothing
   straight up, everything at the horizon. Both are reciprocal, and so is their sum. */
typedef struct { double matt, fibres; } shares;

static shares shares_of(const velvet *v, double cos_o) {
    double sheen = v->sheen;
    return (shares){1.0 - sheen, sheen * fmax(1.0 - cos_o, 0.0)};
}

/* Density of directions at this cosine: each lobe in proportion to what it reflects. */
static double density(shares s, double cos_i) {
    double lobes = s.matt + s.fibres * 3.0 * fmax(1.0 - cos_i, 0.0);
    return lobes / (s.matt + s.fibres) * cos_i / PI;
}

static luxel_spectrum times(luxel_spectrum s, double x) {
    luxel_spectrum out;
    for (int i = 0; i < 4; i++) out.lanes[i] = (float)(s.lanes[i] * x);
    return out;
}

static luxel_status velvet_needs(const void *at, uint32_t *out) {
    const velvet *v = at;
    /* Light is looked for; a lobe is chosen where there are two. */
    *out = v->sheen > 0.0f ? 1 | 2 : 1;
    return LUXEL_OK;
}

static luxel_status velvet_eval(const void *at, const luxel_vec3 *wo, const luxel_vec3 *wi,
                                luxel_eval *out) {
    const velvet *v = at;
    double cos_o = fabs(wo->z), cos_i = fabs(wi->z);
    shares s = shares_of(v, cos_o);
    bool same_side = (wo->z > 0.0f && wi->z > 0.0f) || (wo->z < 0.0f && wi->z < 0.0f);
    *out = (luxel_eval){{{0}}, 0.0f};
    if (!same_side || !(s.matt + s.fibres > 0.0)) return LUXEL_OK;
    double pdf = density(s, fmin(cos_i, 1.0));
    *out = (luxel_eval){times(v->reflectance, (s.matt + s.fibres) * pdf), (float)pdf};
    return LUXEL_OK;
}

/* Exactly in proportion to eval. The cosine of the fibres has the density 6 c (1 - c), whose
   integral is 3 c^2 - 2 c^3; solved for c by Viete's formula for three real roots. */
static luxel_status velvet_sample(const void *at, const luxel_vec3 *wo, const float (*u)[3],
                                  luxel_sample *out) {
    const velvet *v = at;
    shares s = shares_of(v, fabs(wo->z));
    double all = s.matt + s.fibres, part = (*u)[0], turn = (*u)[1], choice = (*u)[2];
    bool legal = part >= 0.0 && part < 1.0 && turn >= 0.0 && turn < 1.0;
    if (!legal || !(all > 0.0) || !(fabs(wo->z) > 0.0f)) return LUXEL_NOTHING;
    bool matt = choice * all < s.matt;
    double cosine = matt ? sqrt(1.0 - part) : 0.5 - sin(asin(1.0 - 2.0 * part) / 3.0);
    float z = (float)cosine;
    /* At the horizon there is no density. */
    if (!(z > 0.0f && z <= 1.0f)) return LUXEL_NOTHING;
    double r = sqrt(fmax(1.0 - (double)z * z, 0.0)), angle = TAU * turn;
    double pdf = density(s, z);
    if (!((float)pdf > 0.0f)) return LUXEL_NOTHING;
    *out = (luxel_sample){
        .weight = times(v->reflectance, all),
        .wi = {(float)(r * cos(angle)), (float)(r * sin(angle)), copysignf(z, wo->z)},
        .pdf = (float)pdf,
        .eta = 1.0f,
    };
    return LUXEL_OK;
}

static const luxel_material_table VELVET = {
    .size = sizeof(luxel_material_table),
    .needs = velvet_needs,
    .eval = velvet_eval,
    .sample = velvet_sample,
};

static const luxel_param VELVET_PARAMS[] = {
    {.name = LUXEL_TEXT("reflectance"), .doc = LUXEL_TEXT("Fraction of light reflected."),
     .ty = LUXEL_TYPE_SPECTRUM, .role = 1, .flags = 2, .preset = 1, .numbers = {0.5}, .min = 0.0,
     .max = 1.0, AT(velvet, reflectance)},
    {.name = LUXEL_TEXT("sheen"),
     .doc = LUXEL_TEXT("How much of it fibres reflect that stand upright: 0 is matt, 1 is black "
                       "where it is seen from straight above."),
     .ty = LUXEL_TYPE_FLOAT, .flags = 2, .preset = 1, .numbers = {0.8}, .min = 0.0, .max = 1.0,
     AT(velvet, sheen)},
};

/* ---- What the library shows ---- */

#define ITEMS(list) { list, sizeof(list) / sizeof(list)[0] }

static const luxel_class CLASSES[] = {
    {.kind = LUXEL_SHAPE, .size = sizeof(disk), .name = LUXEL_TEXT("disk_c"),
     .doc = LUXEL_TEXT(
         "A flat disk, with `inner_radius` a ring, with `sweep` a piece of either.\n\n"
         "A texture lies on it as on the square around it: its middle at (0.5, 0.5).\n\n"
         "```scene\n"
         "shape disk_c { center = (0, 2, 0) m, radius = 30 cm, sweep = 120 deg, material = white }\n"
         "```\n"),
     .params = ITEMS(DISK_PARAMS), .prepare = disk_prepare, .check = disk_check, .behaviour = &DISK},
    {.kind = LUXEL_MATERIAL, .size = sizeof(velvet), .name = LUXEL_TEXT("velvet_c"),
     .doc = LUXEL_TEXT(
         "Velvet: dark where it is seen from above, bright towards its outline. Both of its sides "
         "reflect.\n\n"
         "```scene\n"
         "let curtain = material velvet_c { reflectance = rgb.linear_srgb(0.5, 0.02, 0.1), sheen = 0.9 }\n"
         "```\n"),
     .params = ITEMS(VELVET_PARAMS), .behaviour = &VELVET},
};

LUXEL_EXPORT const luxel_library luxel_plugin_v1_disk_c = {
    .magic = LUXEL_MAGIC,
    .abi_major = LUXEL_ABI_MAJOR,
    .abi_minor = LUXEL_ABI_MINOR,
    .layout_hash = LUXEL_LAYOUT_HASH,
    .size = sizeof(luxel_library),
    .name = LUXEL_TEXT("disk_c"),
    .version = LUXEL_TEXT("0.1.0"),
    .compiler = LUXEL_TEXT("C"),
    .panic = 1, /* C cannot panic. */
    .classes = ITEMS(CLASSES),
};
