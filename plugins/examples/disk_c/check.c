/* The library without a host: every function, asked as the schema allows and beyond.
 *
 *     cc -std=c11 -g -fsanitize=address,undefined -fno-sanitize-recover=all -I plugins/sdk/include \
 *         -o check check.c -lm && ./check
 *
 * Says what failed and ends with 1, or says nothing and ends with 0.
 */
#include "disk_c.c"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXPECT(holds)                                                        \
    do {                                                                     \
        if (!(holds)) {                                                      \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #holds); \
            exit(1);                                                         \
        }                                                                    \
    } while (0)

/* ---- Numbers to ask with ---- */

static uint64_t state = 1;

/* In [0, 1), splitmix64. */
static double draw(void) {
    uint64_t z = (state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) / 9007199254740992.0;
}

static float draw_float(void) {
    return (float)((uint32_t)(draw() * 16777216.0)) / 16777216.0f;
}

static const double ODD[] = {0.0, -0.0, 1.0, -1.0, 1e-300, -1e-300, 1e-12, 1e12, 1e75, -1e75,
                             1e300, DBL_MAX, -DBL_MAX, INFINITY, -INFINITY, NAN, DBL_MIN, 0.5};
#define N_ODD (sizeof(ODD) / sizeof(ODD)[0])

/* Mostly tame, else anything at all. */
static double number(void) {
    return draw() < 0.8 ? 4.0 * draw() - 2.0 : ODD[(size_t)(draw() * N_ODD)];
}

static luxel_dvec3 any_vec(void) {
    double x = number(), y = number();
    return vec(x, y, number());
}

static bool is_finite(luxel_dvec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }
static double length(luxel_dvec3 a) { return sqrt(dot(a, a)); }
static bool is_same(luxel_text a, const char *b) {
    return a.len == strlen(b) && memcmp(a.ptr, b, a.len) == 0;
}

/* ---- Structs as the schema says ---- */

static const luxel_class *class_of(const char *name) {
    const luxel_classes all = luxel_plugin_v1_disk_c.classes;
    for (size_t i = 0; i < all.len; i++)
        if (is_same(all.items[i].name, name)) return &all.items[i];
    EXPECT(!"a class of this name");
    return NULL;
}

static const luxel_param *param_of(const luxel_class *class, const char *name) {
    for (size_t i = 0; i < class->params.len; i++)
        if (is_same(class->params.items[i].name, name)) return &class->params.items[i];
    EXPECT(!"a parameter of this name");
    return NULL;
}

/* Writes numbers at a parameter's offset, as a host does. */
static void put(const luxel_class *class, void *at, const char *name, const double *n) {
    const luxel_param *param = param_of(class, name);
    char *field = (char *)at + param->offset;
    float lanes[4];
    switch (param->ty) {
    case LUXEL_TYPE_FLOAT:
        lanes[0] = (float)n[0];
        memcpy(field, lanes, sizeof(float));
        return;
    case LUXEL_TYPE_SPECTRUM:
        for (int i = 0; i < 4; i++) lanes[i] = (float)n[0];
        memcpy(field, lanes, sizeof lanes);
        return;
    case LUXEL_TYPE_DOUBLE: memcpy(field, n, sizeof(double)); return;
    case LUXEL_TYPE_DVEC3: memcpy(field, n, 3 * sizeof(double)); return;
    default: EXPECT(!"a type that is used here");
    }
}

static void defaults(const luxel_class *class, void *at) {
    memset(at, 0, class->size);
    for (size_t i = 0; i < class->params.len; i++) {
        const luxel_param *param = &class->params.items[i];
        EXPECT(param->doc.len > 0 && param->min <= param->max);
        EXPECT(param->offset < class->size && class->size <= 256);
        char name[32] = {0};
        EXPECT(param->name.len < sizeof name);
        memcpy(name, param->name.ptr, param->name.len);
        if (param->preset == 1) {
            EXPECT(param->numbers[0] >= param->min && param->numbers[0] <= param->max);
            put(class, at, name, param->numbers);
        }
    }
}

/* ---- The shape ---- */

static int n_faults;
static void count(void *owner, luxel_text field, luxel_text code, luxel_text message) {
    (void)owner;
    EXPECT(field.len > 0 && code.len == 5 && message.len > 0);
    n_faults++;
}

static void check_surface(const disk *d, const luxel_surface *s) {
    luxel_bounds box;
    EXPECT(DISK.bounds(d, &box) == LUXEL_OK);
    EXPECT(is_finite(s->p) && is_finite(s->p_err) && isfinite(s->uv.x) && isfinite(s->uv.y));
    EXPECT(fabs(length(s->ng) - 1.0) < 1e-12 && fabs(dot(s->ng, s->ns) - 1.0) < 1e-12);
    EXPECT(s->p.x >= box.min.x && s->p.y >= box.min.y && s->p.z >= box.min.z);
    EXPECT(s->p.x <= box.max.x && s->p.y <= box.max.y && s->p.z <= box.max.z);
    /* On the plane to within the bound: what is computed here rounds three times more. */
    luxel_dvec3 from = minus(s->p, d->center);
    double slack = fabs(s->p_err.x * d->z.x) + fabs(s->p_err.y * d->z.y) + fabs(s->p_err.z * d->z.z);
    EXPECT(fabs(dot(from, d->z)) <= 2.0 * slack + length(from) * gamma_of(6));
    EXPECT(length(s->p_err) <= 1e-13 * (largest(d->center) + d->radius));
}

static void ask_disk(const disk *d) {
    double area, pdf, covered = 0.0;
    uint32_t n = 0;
    EXPECT(DISK.area(d, &area) == LUXEL_OK && area >= 0.0 && isfinite(area));
    for (int i = 0; i < 2000; i++) {
        luxel_ray ray = {any_vec(), any_vec(), i % 3 ? INFINITY : number()};
        if (i % 2) {
            /* Most of these hit; every eighth nearly along the plane. */
            luxel_dvec3 aim = plus(scaled(d->x, (2 * draw() - 1) * d->radius),
                                   scaled(d->y, (2 * draw() - 1) * d->radius));
            ray.d = plus(scaled(d->z, i % 8 == 1 ? -1e-9 : -1.0), scaled(d->x, draw() - 0.5));
            ray.o = minus(plus(d->center, aim), scaled(ray.d, d->radius));
        }
        luxel_hit hit;
        luxel_status status = DISK.intersect(d, &ray, &hit);
        EXPECT(status == LUXEL_OK || status == LUXEL_NOTHING);
        if (status == LUXEL_OK) {
            luxel_surface s;
            EXPECT(is_finite(ray.o) && is_finite(ray.d) && hit.t > 0.0 && hit.t <= ray.t_max);
            EXPECT(DISK.surface(d, &ray, &hit, &s) == LUXEL_OK);
            check_surface(d, &s);
            n++;
        }
        float u[2] = {draw_float(), draw_float()};
        luxel_dvec3 from = any_vec();
        luxel_shape_sample sample;
        status = DISK.sample(d, i % 2 ? &from : NULL, (const float (*)[2]) & u, &sample);
        EXPECT(status == LUXEL_OK || !(area > 1e-300));
        if (status != LUXEL_OK) continue;
        check_surface(d, &sample.surface);
        EXPECT(DISK.pdf(d, NULL, &sample.surface, &pdf) == LUXEL_OK);
        EXPECT(pdf > 0.0 && fabs(pdf / sample.pdf - 1.0) < 1e-12);
        /* Within half the area, inner part: the share of samples is the share of area. */
        double a = dot(minus(sample.surface.p, d->center), d->x);
        double b = dot(minus(sample.surface.p, d->center), d->y);
        double half2 = 0.5 * (d->radius * d->radius + d->inner_radius * d->inner_radius);
        covered += a * a + b * b < half2 ? 1.0 : 0.0;
    }
    /* Five standard deviations of 2000 throws of a coin, where coordinates resolve the disk. */
    if (area > 1e-300 && largest(d->center) < 1e6 * d->radius)
        EXPECT(fabs(covered / 2000.0 - 0.5) < 5.0 * 0.5 / sqrt(2000.0));
    if (d->sweep >= TAU && !(d->inner_radius > 0.0) && largest(d->center) < 10.0 * d->radius)
        EXPECT(n > 500);
    const double bad[] = {NAN, INFINITY, -1.0, 1.0};
    for (size_t i = 0; i < 4; i++) {
        float u[2] = {(float)bad[i], 0.5f};
        luxel_shape_sample sample;
        EXPECT(DISK.sample(d, NULL, (const float (*)[2]) & u, &sample) == LUXEL_NOTHING);
    }
}

static void check_disk(void) {
    const luxel_class *class = class_of("disk_c");
    const luxel_fault_sink sink = {count, NULL};
    const double radii[] = {1.0, 1e-3, 1e6, 1e75, DBL_MIN};
    const double sweeps[] = {TAU, 3.0, 1.0, 1e-3, 5.5};
    const double centers[] = {0.0, 3.0, -1e6, 1e75};
    for (int i = 0; i < 200; i++) {
        disk d;
        double r = radii[i % 5], inner = (i % 3) * 0.45 * r;
        double c[3] = {centers[i % 4], draw(), draw()};
        double n[3] = {draw() - 0.5, draw() - 0.5, draw() - 0.5};
        if (i % 7 == 0) n[0] = n[1] = 0.0;
        if (i % 11 == 0) n[0] = 1e300, n[1] = n[2] = 0.0;
        defaults(class, &d);
        put(class, &d, "radius", &r);
        put(class, &d, "inner_radius", &inner);
        put(class, &d, "sweep", &sweeps[i / 5 % 5]);
        put(class, &d, "center", c);
        put(class, &d, "normal", n);
        if (i % 13 == 0) put(class, &d, "start", n);
        n_faults = 0;
        EXPECT(class->check(&d, &sink) == LUXEL_OK && n_faults == 0);
        EXPECT(class->prepare(&d) == LUXEL_OK);
        EXPECT(fabs(dot(d.x, d.y)) < 1e-14 && fabs(dot(d.y, d.z)) < 1e-14);
        EXPECT(fabs(dot(d.x, d.z)) < 1e-14 && fabs(length(d.x) - 1.0) < 1e-14);
        ask_disk(&d);
    }
    disk d;
    double one = 1.0, nothing[3] = {0, 0, 0}, nan[3] = {NAN, 0, 0};
    defaults(class, &d);
    put(class, &d, "radius", &one);
    put(class, &d, "inner_radius", &one);
    put(class, &d, "normal", nothing);
    n_faults = 0;
    EXPECT(class->check(&d, &sink) == LUXEL_REFUSED && n_faults == 2);
    put(class, &d, "normal", nan);
    EXPECT(class->check(&d, &sink) == LUXEL_REFUSED);
    EXPECT(class->prepare(&d) == LUXEL_OK);
}

/* ---- The material ---- */

static luxel_vec3 direction(void) {
    double z = 2.0 * draw() - 1.0, phi = TAU * draw();
    if (draw() < 0.2) z = copysign(draw() < 0.5 ? 1e-6 : 1e-30, z);
    double r = sqrt(1.0 - z * z);
    return (luxel_vec3){(float)(r * cos(phi)), (float)(r * sin(phi)), (float)z};
}

static bool is_legal(const luxel_eval *e) {
    for (int i = 0; i < 4; i++)
        if (!(e->f.lanes[i] >= 0.0f && isfinite(e->f.lanes[i]))) return false;
    return e->pdf >= 0.0f && isfinite(e->pdf);
}

static void ask_velvet(const velvet *v) {
    uint32_t needs;
    EXPECT(VELVET.needs(v, &needs) == LUXEL_OK && (needs & 1));
    for (int i = 0; i < 3000; i++) {
        luxel_vec3 wo = direction(), wi = direction();
        luxel_eval there, back;
        if (i % 10 == 0) wo.z = (float)number();
        if (i % 10 == 5) wi.z = (float)number();
        EXPECT(VELVET.eval(v, &wo, &wi, &there) == LUXEL_OK);
        bool tame = fabsf(wo.z) <= 1.0f && fabsf(wi.z) <= 1.0f;
        EXPECT(!tame || is_legal(&there));
        EXPECT(VELVET.eval(v, &wi, &wo, &back) == LUXEL_OK);
        /* A few roundings to f32 of each value. */
        double f = there.f.lanes[0] * fabs(wo.z), g = back.f.lanes[0] * fabs(wi.z);
        EXPECT(!tame || fabs(f - g) <= 1e-6 * fmax(f, g) + 1e-37);
        float u[3] = {draw_float(), draw_float(), draw_float()};
        luxel_sample s;
        luxel_status status = VELVET.sample(v, &wo, (const float (*)[3]) & u, &s);
        EXPECT(status == LUXEL_OK || status == LUXEL_NOTHING);
        if (status == LUXEL_NOTHING || !tame) continue;
        EXPECT(VELVET.eval(v, &wo, &s.wi, &there) == LUXEL_OK && is_legal(&there));
        EXPECT(s.pdf > 0.0f && fabsf(s.pdf - there.pdf) <= 1e-6f * s.pdf);
        EXPECT(s.weight.lanes[0] >= 0.0f && s.weight.lanes[0] <= 1.0f && s.eta >= 1.0f);
        double value = (double)s.weight.lanes[0] * s.pdf;
        EXPECT(fabs(value - there.f.lanes[0]) <= 1e-6 * value + 1e-37);
        double l2 = (double)s.wi.x * s.wi.x + (double)s.wi.y * s.wi.y + (double)s.wi.z * s.wi.z;
        EXPECT(fabs(l2 - 1.0) < 1e-6 && (s.wi.z > 0.0f) == (wo.z > 0.0f));
    }
    luxel_vec3 up = {0, 0, 1}, none = {NAN, NAN, NAN};
    const float odd[] = {NAN, INFINITY, -1.0f, 1.0f};
    for (int i = 0; i < 4; i++) {
        float u[3] = {odd[i], odd[i], 0.5f};
        luxel_sample s;
        luxel_eval e;
        EXPECT(VELVET.sample(v, &up, (const float (*)[3]) & u, &s) == LUXEL_NOTHING);
        EXPECT(VELVET.eval(v, &none, &up, &e) == LUXEL_OK && is_legal(&e));
        EXPECT(VELVET.eval(v, &up, &none, &e) == LUXEL_OK && is_legal(&e));
    }
}

static void check_velvet(void) {
    const luxel_class *class = class_of("velvet_c");
    const double sheens[] = {0.0, 1e-6, 0.3, 0.8, 1.0};
    for (int i = 0; i < 5; i++) {
        velvet v;
        double white = 1.0;
        defaults(class, &v);
        put(class, &v, "reflectance", &white);
        put(class, &v, "sheen", &sheens[i]);
        ask_velvet(&v);
        /* What is reflected of light from everywhere, by quadrature: 1 - sheen cos_o. */
        for (double cos_o = 0.1; cos_o < 1.0; cos_o += 0.2) {
            luxel_vec3 wo = {(float)sqrt(1.0 - cos_o * cos_o), 0.0f, (float)cos_o};
            double sum = 0.0, pdf = 0.0;
            for (int k = 0; k < 1000; k++) {
                double c = (k + 0.5) / 1000.0;
                luxel_vec3 wi = {0.0f, (float)sqrt(1.0 - c * c), (float)c};
                luxel_eval e;
                EXPECT(VELVET.eval(&v, &wo, &wi, &e) == LUXEL_OK);
                sum += TAU * e.f.lanes[0] / 1000.0;
                pdf += TAU * e.pdf / 1000.0;
            }
            /* The midpoint rule is off by at most |f''|/24 n^2 = 6 / 24e6; f32 by 1e-7 of each. */
            EXPECT(fabs(sum - (1.0 - v.sheen * cos_o)) < 1e-6 && fabs(pdf - 1.0) < 1e-6);
        }
    }
}

int main(void) {
    EXPECT(luxel_plugin_v1_disk_c.magic == LUXEL_MAGIC && luxel_plugin_v1_disk_c.classes.len == 2);
    check_disk();
    check_velvet();
    return 0;
}
