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

#define LUXEL_MAGIC 0x001a0d4c4558554cull
#define LUXEL_ABI_MAJOR 1
#define LUXEL_ABI_MINOR 0
#define LUXEL_LAYOUT_HASH 0xc7b095d31bf1f2fbull

/* Kinds of plugin. */
#define LUXEL_SHAPE 0
#define LUXEL_MATERIAL 1
#define LUXEL_TEXTURE 2
#define LUXEL_LIGHT 3
#define LUXEL_MEDIUM 4
#define LUXEL_PHASE 5
#define LUXEL_CAMERA 6
#define LUXEL_SAMPLER 7
#define LUXEL_FILTER 8
#define LUXEL_INTEGRATOR 9
#define LUXEL_ASSET 10

/* How a parameter is stored. */
#define LUXEL_TYPE_FLOAT 0
#define LUXEL_TYPE_DOUBLE 1
#define LUXEL_TYPE_INT 2
#define LUXEL_TYPE_BOOL 3
#define LUXEL_TYPE_VEC2 4
#define LUXEL_TYPE_VEC3 5
#define LUXEL_TYPE_DVEC3 6
#define LUXEL_TYPE_SPECTRUM 7
#define LUXEL_TYPE_COMPLEXIOR 8
#define LUXEL_TYPE_CHOICE 9
#define LUXEL_TYPE_TEXT 10
#define LUXEL_TYPE_FILE 11
#define LUXEL_TYPE_TABLE 12
#define LUXEL_TYPE_LOOK 13
#define LUXEL_TYPE_MAYBEFLOAT 14
#define LUXEL_TYPE_EMISSION 15
#define LUXEL_TYPE_PART 16
#define LUXEL_TYPE_HANDLE 32 /* and the kind */

/* A ray: origin, direction, and where it ends in lengths of the direction. */
typedef struct {
    luxel_dvec3 o;
    luxel_dvec3 d;
    double t_max;
} luxel_ray;

/* A box. */
typedef struct {
    luxel_dvec3 min;
    luxel_dvec3 max;
} luxel_bounds;

/* A metal's index of refraction, eta - i k. */
typedef struct {
    luxel_spectrum eta;
    luxel_spectrum k;
} luxel_complex_ior;

/* Emitted light, and which amount was given: 0 scale, 1 power, 2 radiance, 3 intensity,
   4 illuminance. */
typedef struct {
    luxel_spectrum spectrum;
    uint32_t quantity;
} luxel_emission;

/* Where something stands, what it faces, which way is up. */
typedef struct {
    luxel_dvec3 from;
    luxel_dvec3 to;
    luxel_dvec3 up;
} luxel_look;

/* Wavelengths of a path, nm, and their densities. */
typedef struct {
    luxel_spectrum lambda;
    luxel_spectrum pdf;
} luxel_wavelengths;

/* Where a ray met a shape, in the shape's own parameters. */
typedef struct {
    double t;
    luxel_dvec2 at;
    uint32_t face;
} luxel_hit;

/* A point of a surface. */
typedef struct {
    luxel_dvec3 p;
    luxel_dvec3 p_err;
    luxel_dvec3 ng;
    luxel_dvec3 ns;
    luxel_dvec2 uv;
    luxel_dvec3 dp_du;
    luxel_dvec3 dp_dv;
} luxel_surface;

/* A sampled point of a surface, and its density per m². */
typedef struct {
    luxel_surface surface;
    double pdf;
} luxel_shape_sample;

/* A flat piece: its middle, and its edges from end to end. */
typedef struct {
    luxel_dvec3 centre;
    luxel_dvec3 u;
    luxel_dvec3 v;
} luxel_parallelogram;

/* Derivatives of the unit shading normal by the surface coordinates. */
typedef struct {
    luxel_dvec3 dn_du;
    luxel_dvec3 dn_dv;
} luxel_normal_derivatives;

/* f·|cos_i| and the density of finding the direction. */
typedef struct {
    luxel_spectrum f;
    float pdf;
} luxel_eval;

/* A sampled direction. Lobes: 1 delta, 2 transmission, 4 dispersive. */
typedef struct {
    luxel_spectrum weight;
    luxel_vec3 wi;
    float pdf;
    float eta;
    uint32_t lobe;
} luxel_sample;

/* Where a texture is looked up. */
typedef struct {
    luxel_dvec3 p;
    luxel_vec2 uv;
    luxel_wavelengths lambda;
} luxel_texture_point;

/* For which point light is looked for. */
typedef struct {
    luxel_dvec3 p;
    float u[2];
} luxel_light_query;

/* Light that may reach a point. */
typedef struct {
    luxel_spectrum le;
    luxel_dvec3 wi;
    double distance;
    float pdf;
    bool delta;
} luxel_light_sample;

/* What a ray that leaves the scene finds. */
typedef struct {
    luxel_spectrum le;
    float pdf;
} luxel_escaped;

/* How far a ray flew freely. */
typedef struct {
    luxel_maybe_double t;
    luxel_spectrum weight;
} luxel_free_flight;

/* The picture's size in pixels. */
typedef struct {
    luxel_uvec2 size;
} luxel_raster;

/* A ray from the camera, and what radiance along it counts for. */
typedef struct {
    luxel_ray ray;
    float weight;
} luxel_camera_ray;

/* Which random number. */
typedef struct {
    uint32_t stream;
    uint32_t index;
    uint32_t dimension;
} luxel_sample_at;

/* Where the camera sees a place: the ray to its eye, the pixel by its place in the rows, and
   what one unit of beta adds to the pixel. */
typedef struct {
    luxel_ray ray;
    uint32_t pixel;
    luxel_spectrum f_we;
} luxel_sight;

/* A sight, where there is one. */
typedef struct {
    bool given;
    luxel_sight value;
} luxel_maybe_sight;

/* One path to be followed: the camera's ray, or one that leaves a light, what it carries, and
   where the camera sees the light. */
typedef struct {
    luxel_ray ray;
    luxel_spectrum beta;
    luxel_maybe_sight sight;
} luxel_job;

/* One light sample with the material's answer. */
typedef struct {
    luxel_ray ray;
    luxel_spectrum f_le;
    float pdf;
    float f_pdf;
} luxel_direct;

/* One scattering sample, in world space. */
typedef struct {
    luxel_spectrum weight;
    luxel_dvec3 wi;
    float pdf;
    float eta;
} luxel_scatter;

/* A light sample, where there is one. */
typedef struct {
    bool given;
    luxel_direct value;
} luxel_maybe_direct;

/* A scattering sample, where there is one. */
typedef struct {
    bool given;
    luxel_scatter value;
} luxel_maybe_scatter;

/* A point that a path arrived at. Kinds: 0 escaped, 1 surface, 2 medium. */
typedef struct {
    uint32_t kind;
    luxel_dvec3 p;
    luxel_dvec3 p_err;
    luxel_dvec3 ng;
    luxel_dvec3 ns;
    luxel_dvec3 lift;
    luxel_vec2 uv;
    double t;
    luxel_dvec3 wo;
    uint32_t material;
    uint32_t steps;
    luxel_spectrum le;
    float le_pdf;
    luxel_spectrum glow;
    luxel_maybe_direct direct;
    luxel_maybe_scatter scatter;
    luxel_maybe_sight sight;
    float curvature;
} luxel_arrival;

/* A path in flight. */
typedef struct {
    luxel_arrival at;
    luxel_spectrum l;
    luxel_spectrum glow;
    luxel_sample_at numbers;
} luxel_lane;

/* A ray with the path that goes on along it. */
typedef struct {
    luxel_ray ray;
    uint32_t lane;
} luxel_onward;

/* A shadow ray with the light that it decides about, for the path's own pixel (UINT32_MAX) or
   for another, by its place in the rows. */
typedef struct {
    luxel_ray ray;
    uint32_t lane;
    uint32_t pixel;
    luxel_spectrum l;
} luxel_shadow;

/* A sphere around the scene. */
typedef struct {
    luxel_dvec3 centre;
    double radius;
} luxel_scene_sphere;

/* Triangles that a shape hands over. */
typedef struct {
    luxel_dvec3 centre;
    luxel_vec3s points;
    luxel_triangles_of indices;
    luxel_vec3s normals;
    luxel_vec2s uvs;
    luxel_vec3s colors;
    luxel_dvec2 later_times;
    luxel_vec3s later_points;
    luxel_vec3s later_normals;
} luxel_triangles;

/* A shared table on its way. */
typedef struct {
    const void *address;
    void *owner;
} luxel_built;

/* A value of an imported node. Tags: 0 bool, 1 number, 2 quantity, 3 vector, 4 text, 5 rgb,
   6 table, 7 look, 8 bytes, 9 node. */
typedef struct {
    uint32_t tag;
    uint32_t index;
    double numbers[9];
    luxel_text text;
    luxel_doubles table;
    luxel_bytes bytes;
} luxel_import_value;

/* One parameter. Flags: 1 required, 2 textured. Presets: 0 none, 1 numbers, 2 a choice, 3 text.
   Roles: 0 plain, 1 reflectance, 2 illuminant, 3 ior, 4 complex ior, 5 coefficient, 6 waves. */
typedef struct {
    luxel_text name;
    luxel_text doc;
    uint32_t ty;
    uint32_t role;
    luxel_text unit;
    uint32_t preset;
    uint32_t flags;
    double numbers[4];
    luxel_text text;
    double min;
    double max;
    luxel_texts choices;
    luxel_text group;
    luxel_text deprecated;
    uint64_t offset;
} luxel_param;

typedef struct { const luxel_ray *items; size_t len; } luxel_rays;
/* A list of the host's. To add: if len == capacity call grow, then items[len++] = item. */
typedef struct luxel_onward_queue {
    luxel_onward *items;
    size_t len, capacity;
    void (*grow)(struct luxel_onward_queue *);
} luxel_onward_queue;
typedef struct luxel_shadow_queue {
    luxel_shadow *items;
    size_t len, capacity;
    void (*grow)(struct luxel_shadow_queue *);
} luxel_shadow_queue;

/* What a round of arrivals asks for. */
typedef struct {
    luxel_onward_queue rays;
    luxel_shadow_queue shadows;
} luxel_requests;

/* What a path that begins may ask: light into `l`, that of media into `glow`, rays into `requests`. */
typedef struct {
    uint32_t lane;
    luxel_spectrum *l;
    luxel_spectrum *glow;
    luxel_requests *requests;
} luxel_ask;

/* How a surface scatters light. Directions are unit vectors in the local frame. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* What it looks at, as flags: 1 light, 2 the third random number, 4 the tangent. */
    luxel_status (*needs)(const void *at, uint32_t *out);
    /* f·|cosine| and the density with which `sample` finds `wi`. */
    luxel_status (*eval)(const void *at, const luxel_vec3 *wo, const luxel_vec3 *wi, luxel_eval *out);
    /* A direction; nothing where nothing is scattered. */
    luxel_status (*sample)(const void *at, const luxel_vec3 *wo, const float (*u)[3], luxel_sample *out);
} luxel_material_table;

/* How a medium scatters light. Directions are unit vectors in world space, away from the point. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* The phase function, sr⁻¹, and the density of `sample`. */
    luxel_status (*eval)(const void *at, const luxel_vec3 *wo, const luxel_vec3 *wi, luxel_eval *out);
    /* A direction. */
    luxel_status (*sample)(const void *at, const luxel_vec3 *wo, const float (*u)[2], luxel_sample *out);
} luxel_phase_table;

/* A value that varies over a surface or through space. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* The value at a point. */
    luxel_status (*eval)(const void *at, const luxel_texture_point *point, luxel_spectrum *out);
    /* What the lanes mean: 0 values as they are, 1 linear sRGB, 2 the same where the surface has no
       colours of its own. */
    luxel_status (*output)(const void *at, uint32_t *out);
} luxel_texture_table;

/* Where random numbers come from: the same for the same arguments, in [0, 1). */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* Samples per pixel. */
    luxel_status (*samples)(const void *at, uint32_t *out);
    /* The seed. */
    luxel_status (*seed)(const void *at, uint32_t *out);
    /* One number. */
    luxel_status (*get_1d)(const void *at, const luxel_sample_at *which, float *out);
    /* Two numbers that are spread over the square together. */
    luxel_status (*get_2d)(const void *at, const luxel_sample_at *which, float (*out)[2]);
    /* Two such pairs, the second two dimensions on. */
    luxel_status (*get_2d_pair)(const void *at, const luxel_sample_at *which, float (*out)[2][2]);
} luxel_sampler_table;

/* Another material, resolved at the same point. */
typedef struct {
    const luxel_material_table *table;
    const void *at;
} luxel_material_ref;

/* A phase function. */
typedef struct {
    const luxel_phase_table *table;
    const void *at;
} luxel_phase_ref;

/* A texture, to be asked anywhere; without a table there is none. */
typedef struct {
    const luxel_texture_table *table;
    const void *at;
} luxel_texture_ref;

/* A sampler. */
typedef struct {
    const luxel_sampler_table *table;
    const void *at;
} luxel_sampler_ref;

/* The numbers of one path: add to next.dimension what was taken. */
typedef struct {
    luxel_sampler_ref source;
    luxel_sample_at next;
} luxel_samples_ref;

/* What the host answers while a path arrives. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* Whether something lies along a ray: 1 or 0. */
    luxel_status (*occluded)(const void *at, const luxel_ray *ray, uint32_t *out);
    /* A sphere around the scene. */
    luxel_status (*scene_sphere)(const void *at, luxel_scene_sphere *out);
} luxel_host_table;

/* The host. */
typedef struct {
    const luxel_host_table *table;
    const void *at;
} luxel_host_ref;

/* What the host offers a round of arrivals. */
typedef struct {
    luxel_host_ref host;
    luxel_sampler_ref sampler;
} luxel_round_ref;

/* Paths in flight, and which of them arrived. */
typedef struct {
    luxel_lane *lanes;
    size_t n_lanes;
    void *states;
    luxel_u32s arrived;
} luxel_lanes;

/* Where bytes go. */
typedef struct {
    void (*take)(void *owner, luxel_bytes bytes);
    void *owner;
} luxel_byte_sink;
/* Where faults go: the field (empty for the whole), a code such as "E0405", the message. */
typedef struct {
    void (*take)(void *owner, luxel_text field, luxel_text code, luxel_text message);
    void *owner;
} luxel_fault_sink;
/* Where triangles go. */
typedef struct {
    void (*take)(void *owner, const luxel_triangles *triangles);
    void *owner;
} luxel_mesh_sink;
/* Where imported nodes go. A value belongs to the last node; kinds as above. */
typedef struct {
    void *owner;
    void (*node)(void *owner, uint32_t kind, luxel_text class_name, luxel_text label);
    void (*value)(void *owner, luxel_text name, const luxel_import_value *value);
    void (*place)(void *owner, uint32_t node, const double columns[12]);
    void (*warn)(void *owner, luxel_text message);
} luxel_import_sink;
/* What building may ask. Files: LUXEL_OK and the bytes, or LUXEL_REFUSED and the reason. */
typedef struct {
    size_t size;
    luxel_status (*read)(const void *at, luxel_text base, luxel_text path, luxel_byte_sink *sink);
    luxel_status (*warn)(const void *at, luxel_text message);
    luxel_status (*cancelled)(const void *at);
    /* What is built keeps so many bytes more: of who never tells, the bytes that were read count. */
    luxel_status (*holds)(const void *at, size_t bytes);
} luxel_context_table;

/* Paths that a picture is made of: what happens when one begins and when it arrives. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* What the host prepares at each arrival, as the integrator's `wants`. */
    luxel_status (*wants)(const void *at, uint32_t *out);
    /* Bytes of what a path remembers. */
    luxel_status (*state_bytes)(const void *at, uint64_t *out);
    /* A path begins: writes its state and asks; says 0. */
    luxel_status (*start)(const void *at, void *state, const luxel_job *job, luxel_ask *ask, uint32_t *out);
    /* The paths in some lanes arrived; says 0. */
    luxel_status (*arrive_n)(const void *at, luxel_lanes *lanes, const luxel_round_ref *round, luxel_requests *requests, uint32_t *out);
} luxel_paths_table;

/* Paths that a picture is made of; `last_panic` may be null. */
typedef struct {
    const luxel_paths_table *table;
    const void *at;
    void (*last_panic)(luxel_byte_sink *sink);
} luxel_paths_ref;

/* What the host does for an integrator that owns the picture. All say 0 that have nothing to
   tell. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* The picture's size. */
    luxel_status (*raster)(const void *at, luxel_raster *out);
    /* Passes that were asked for: each gives every pixel one sample. */
    luxel_status (*samples)(const void *at, uint32_t *out);
    /* The seed. */
    luxel_status (*seed)(const void *at, uint32_t *out);
    /* Whether an end was asked for: 1 or 0. */
    luxel_status (*is_cancelled)(const void *at, uint32_t *out);
    /* Where rays arrive: positions alone. Room for as many results as there are rays. */
    luxel_status (*trace_n)(const void *at, const luxel_rays *rays, luxel_arrival *arrivals, uint32_t *out);
    /* Whether something lies along rays. Room for as many results as there are rays. */
    luxel_status (*occluded_n)(const void *at, const luxel_rays *rays, bool *occluded, uint32_t *out);
    /* Follows one path from the camera through every pixel; what it adds is added to this pass. */
    luxel_status (*run_camera_paths)(const void *at, const luxel_paths_ref *paths, uint32_t *out);
    /* Follows paths from the lights; what they splat, divided by their number, is added to this
       pass. */
    luxel_status (*run_light_paths)(const void *at, uint32_t n, const luxel_paths_ref *paths, uint32_t *out);
    /* Ends the pass: its light becomes one sample of every pixel. */
    luxel_status (*finish_pass)(const void *at, uint32_t *out);
} luxel_picture_job_table;

/* What the host does for an integrator that owns the picture. */
typedef struct {
    const luxel_picture_job_table *table;
    const void *at;
} luxel_picture_job_ref;

/* What building may ask of the host. */
typedef struct {
    const luxel_context_table *table;
    const void *at;
} luxel_context_ref;

/* Geometry in its own frame, in double precision. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* A box that holds every point of the surface. */
    luxel_status (*bounds)(const void *at, luxel_bounds *out);
    /* The nearest hit with 0 < t <= ray->t_max; nothing where there is none. */
    luxel_status (*intersect)(const void *at, const luxel_ray *ray, luxel_hit *out);
    /* The point that a hit names. */
    luxel_status (*surface)(const void *at, const luxel_ray *ray, const luxel_hit *hit, luxel_surface *out);
    /* Area in the frame of the shape, m²; infinite for one that cannot shine. */
    luxel_status (*area)(const void *at, double *out);
    /* A point of the surface; `from` may be null. */
    luxel_status (*sample)(const void *at, const luxel_dvec3 *from, const float (*u)[2], luxel_shape_sample *out);
    /* The density with which `sample` finds a point, m⁻². */
    luxel_status (*pdf)(const void *at, const luxel_dvec3 *from, const luxel_surface *point, double *out);
    /* Whether the surface encloses a volume: 1 or 0. */
    luxel_status (*is_closed)(const void *at, uint32_t *out);
    /* Hands triangles over, and says how many; nothing for shapes that intersect themselves. */
    luxel_status (*mesh)(const void *at, luxel_mesh_sink *sink, uint64_t *out);
    /* How many parts it consists of, over which the host builds a tree; 0 for one all in one. */
    luxel_status (*parts)(const void *at, uint32_t *out);
    /* A box that holds every point of a part, counted from 0. */
    luxel_status (*part_bounds)(const void *at, uint32_t part, luxel_bounds *out);
    /* The nearest hit of one part. */
    luxel_status (*intersect_part)(const void *at, uint32_t part, const luxel_ray *ray, luxel_hit *out);
    /* At least how far away the surface is, negative inside; nothing where that is not known. */
    luxel_status (*distance)(const void *at, const luxel_dvec3 *p, double *out);
    /* The parallelogram that it is, where it is nothing else. */
    luxel_status (*parallelogram)(const void *at, luxel_parallelogram *out);
    /* How the shading normal turns at a point; nothing where that is not known. */
    luxel_status (*normal_derivatives)(const void *at, const luxel_hit *hit, const luxel_surface *point, luxel_normal_derivatives *out);
} luxel_shape_table;

/* A shape of which another one is made. */
typedef struct {
    const luxel_shape_table *table;
    const void *at;
} luxel_shape_ref;

/* A source of light, in its own frame. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* What form of source it is: 0 a shape's surface, 1 a point, 2 far away. */
    luxel_status (*form)(const void *at, uint32_t *out);
    /* Radiance that leaves a shining surface of `area` m² (world) at cosine `cos_o`. */
    luxel_status (*le)(const void *at, float cos_o, const luxel_vec2 *uv, double area, luxel_spectrum *out);
    /* Light that may reach a point. */
    luxel_status (*sample)(const void *at, const luxel_light_query *query, luxel_light_sample *out);
    /* What a ray that leaves the scene along `d` finds. */
    luxel_status (*escaped)(const void *at, const luxel_dvec3 *d, luxel_escaped *out);
    /* About how much power it gives, W. */
    luxel_status (*power)(const void *at, double area, double scene_radius, float *out);
    /* What the lanes of its radiance mean: 0 values as they are, 1 linear sRGB. */
    luxel_status (*output)(const void *at, uint32_t *out);
} luxel_light_table;

/* What fills space. Rays are in world space, of unit direction, and end at `t_max`. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* How far a ray flies before it is scattered. */
    luxel_status (*sample)(const void *at, const luxel_ray *ray, luxel_samples_ref *samples, luxel_free_flight *out);
    /* The fraction of light that passes. */
    luxel_status (*transmittance)(const void *at, const luxel_ray *ray, luxel_samples_ref *samples, luxel_spectrum *out);
    /* How it scatters: a handle that is valid as long as the parameters. */
    luxel_status (*phase)(const void *at, luxel_phase_ref *out);
    /* The light that it sends itself towards where the ray begins. */
    luxel_status (*glow)(const void *at, const luxel_ray *ray, luxel_samples_ref *samples, luxel_spectrum *out);
} luxel_medium_table;

/* A camera, in world space. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* The ray through a place of the picture; nothing where nothing is seen. */
    luxel_status (*ray)(const void *at, const luxel_raster *raster, const luxel_dvec2 *p, const float (*lens)[2], luxel_camera_ray *out);
    /* Where a point appears through the centre of the lens; nothing behind it. */
    luxel_status (*project)(const void *at, const luxel_raster *raster, const luxel_dvec3 *p, luxel_dvec2 *out);
} luxel_camera_table;

/* A pixel filter that is nowhere negative. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* Half its width, pixels. */
    luxel_status (*radius)(const void *at, float *out);
    /* Its value at an offset from the pixel's centre. */
    luxel_status (*eval)(const void *at, const float (*offset)[2], float *out);
    /* An offset with density `eval`. */
    luxel_status (*sample)(const void *at, const float (*u)[2], float (*out)[2]);
} luxel_filter_table;

/* How light is followed: what happens when a path begins and when it arrives. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* What the host prepares at each arrival, as flags: 1 emission, 2 a light sample, 4 a
       scattering sample, 8 where the camera sees it, 16 curvature. Of what owns the picture: for all its paths. */
    luxel_status (*wants)(const void *at, uint32_t *out);
    /* What the lanes of its light mean: 0 values as they are, 1 linear sRGB. */
    luxel_status (*output)(const void *at, uint32_t *out);
    /* Bytes of what a path remembers. */
    luxel_status (*state_bytes)(const void *at, uint64_t *out);
    /* A path begins: writes its state and asks; says 0. */
    luxel_status (*start)(const void *at, void *state, const luxel_job *job, luxel_ask *ask, uint32_t *out);
    /* The paths in some lanes arrived; says 0. */
    luxel_status (*arrive_n)(const void *at, luxel_lanes *lanes, const luxel_round_ref *round, luxel_requests *requests, uint32_t *out);
    /* Whether it owns the whole picture: 1 or 0. Then `render` is called, and no path of its
       own begins. May be null: it does not. */
    luxel_status (*is_picture)(const void *at, uint32_t *out);
    /* Makes the picture; says 0. Nothing where it does not own it; may be null then. */
    luxel_status (*render)(const void *at, const luxel_picture_job_ref *job, uint32_t *out);
    /* 1 if it owns the picture and no pass of it depends on what earlier ones found or counted, nor on
       how many there are to be, so that the host may leave out those that a picture has; else 0. May
       be null: 0. */
    luxel_status (*has_independent_passes)(const void *at, uint32_t *out);
} luxel_integrator_table;

/* Bytes of another format into nodes of a scene. */
typedef struct {
    /* Bytes of this table. */
    size_t size;
    /* Reads the file that the parameters name, pours nodes into `sink`, tells faults; the
       number of nodes, or nothing where there were faults. */
    luxel_status (*import)(const void *at, const luxel_context_ref *context, luxel_import_sink *sink, const luxel_fault_sink *faults, uint64_t *out);
} luxel_importer_table;

typedef struct { const luxel_param *items; size_t len; } luxel_params;

/* One plugin. Functions may be null where there is nothing to do. */
typedef struct {
    uint32_t kind;
    uint32_t size; /* of the parameter struct, at most 256 bytes */
    luxel_text name;
    luxel_text doc;
    luxel_params params;
    luxel_status (*prepare)(void *at);
    luxel_status (*check)(const void *at, const luxel_fault_sink *faults);
    luxel_status (*build)(const void *at, const luxel_context_ref *context,
                          const luxel_fault_sink *faults, luxel_built *out);
    luxel_status (*free)(void *owner);
    uint64_t shared_offset;
    const void *behaviour; /* the table of the kind */
} luxel_class;

typedef struct { const luxel_class *items; size_t len; } luxel_classes;

/* What a library shows as `luxel_plugin_v1_<stem>`, for libstem.so: const, no function. */
typedef struct {
    uint64_t magic;
    uint32_t abi_major, abi_minor;
    uint64_t layout_hash;
    size_t size;
    luxel_text name, version, compiler;
    uint32_t panic; /* 1: this is not Rust */
    luxel_classes classes;
    void (*begin)(void);
    void (*last_panic)(luxel_byte_sink *sink);
} luxel_library;

/* The layout, as the host knows it. */
LUXEL_CHECK(sizeof(luxel_vec2) == 8, "size of luxel_vec2");
LUXEL_CHECK(_Alignof(luxel_vec2) == 4, "alignment of luxel_vec2");
LUXEL_CHECK(offsetof(luxel_vec2, x) == 0, "luxel_vec2.x");
LUXEL_CHECK(offsetof(luxel_vec2, y) == 4, "luxel_vec2.y");
LUXEL_CHECK(sizeof(luxel_vec3) == 12, "size of luxel_vec3");
LUXEL_CHECK(_Alignof(luxel_vec3) == 4, "alignment of luxel_vec3");
LUXEL_CHECK(offsetof(luxel_vec3, x) == 0, "luxel_vec3.x");
LUXEL_CHECK(offsetof(luxel_vec3, y) == 4, "luxel_vec3.y");
LUXEL_CHECK(offsetof(luxel_vec3, z) == 8, "luxel_vec3.z");
LUXEL_CHECK(sizeof(luxel_dvec2) == 16, "size of luxel_dvec2");
LUXEL_CHECK(_Alignof(luxel_dvec2) == 8, "alignment of luxel_dvec2");
LUXEL_CHECK(offsetof(luxel_dvec2, x) == 0, "luxel_dvec2.x");
LUXEL_CHECK(offsetof(luxel_dvec2, y) == 8, "luxel_dvec2.y");
LUXEL_CHECK(sizeof(luxel_dvec3) == 24, "size of luxel_dvec3");
LUXEL_CHECK(_Alignof(luxel_dvec3) == 8, "alignment of luxel_dvec3");
LUXEL_CHECK(offsetof(luxel_dvec3, x) == 0, "luxel_dvec3.x");
LUXEL_CHECK(offsetof(luxel_dvec3, y) == 8, "luxel_dvec3.y");
LUXEL_CHECK(offsetof(luxel_dvec3, z) == 16, "luxel_dvec3.z");
LUXEL_CHECK(sizeof(luxel_uvec2) == 8, "size of luxel_uvec2");
LUXEL_CHECK(_Alignof(luxel_uvec2) == 4, "alignment of luxel_uvec2");
LUXEL_CHECK(offsetof(luxel_uvec2, x) == 0, "luxel_uvec2.x");
LUXEL_CHECK(offsetof(luxel_uvec2, y) == 4, "luxel_uvec2.y");
LUXEL_CHECK(sizeof(luxel_spectrum) == 16, "size of luxel_spectrum");
LUXEL_CHECK(_Alignof(luxel_spectrum) == 16, "alignment of luxel_spectrum");
LUXEL_CHECK(sizeof(luxel_text) == 16, "size of luxel_text");
LUXEL_CHECK(_Alignof(luxel_text) == 8, "alignment of luxel_text");
LUXEL_CHECK(offsetof(luxel_text, ptr) == 0, "luxel_text.ptr");
LUXEL_CHECK(offsetof(luxel_text, len) == 8, "luxel_text.len");
LUXEL_CHECK(sizeof(luxel_bytes) == 16, "size of luxel_bytes");
LUXEL_CHECK(_Alignof(luxel_bytes) == 8, "alignment of luxel_bytes");
LUXEL_CHECK(offsetof(luxel_bytes, items) == 0, "luxel_bytes.items");
LUXEL_CHECK(offsetof(luxel_bytes, len) == 8, "luxel_bytes.len");
LUXEL_CHECK(sizeof(luxel_rays) == 16, "size of luxel_rays");
LUXEL_CHECK(_Alignof(luxel_rays) == 8, "alignment of luxel_rays");
LUXEL_CHECK(offsetof(luxel_rays, items) == 0, "luxel_rays.items");
LUXEL_CHECK(offsetof(luxel_rays, len) == 8, "luxel_rays.len");
LUXEL_CHECK(sizeof(luxel_shadow_queue) == 32, "size of luxel_shadow_queue");
LUXEL_CHECK(_Alignof(luxel_shadow_queue) == 8, "alignment of luxel_shadow_queue");
LUXEL_CHECK(offsetof(luxel_shadow_queue, items) == 0, "luxel_shadow_queue.items");
LUXEL_CHECK(offsetof(luxel_shadow_queue, len) == 8, "luxel_shadow_queue.len");
LUXEL_CHECK(offsetof(luxel_shadow_queue, capacity) == 16, "luxel_shadow_queue.capacity");
LUXEL_CHECK(offsetof(luxel_shadow_queue, grow) == 24, "luxel_shadow_queue.grow");
LUXEL_CHECK(sizeof(luxel_maybe_float) == 8, "size of luxel_maybe_float");
LUXEL_CHECK(_Alignof(luxel_maybe_float) == 4, "alignment of luxel_maybe_float");
LUXEL_CHECK(offsetof(luxel_maybe_float, given) == 0, "luxel_maybe_float.given");
LUXEL_CHECK(offsetof(luxel_maybe_float, value) == 4, "luxel_maybe_float.value");
LUXEL_CHECK(sizeof(luxel_maybe_double) == 16, "size of luxel_maybe_double");
LUXEL_CHECK(_Alignof(luxel_maybe_double) == 8, "alignment of luxel_maybe_double");
LUXEL_CHECK(offsetof(luxel_maybe_double, given) == 0, "luxel_maybe_double.given");
LUXEL_CHECK(offsetof(luxel_maybe_double, value) == 8, "luxel_maybe_double.value");
LUXEL_CHECK(sizeof(luxel_byte_sink) == 16, "size of luxel_byte_sink");
LUXEL_CHECK(_Alignof(luxel_byte_sink) == 8, "alignment of luxel_byte_sink");
LUXEL_CHECK(offsetof(luxel_byte_sink, take) == 0, "luxel_byte_sink.take");
LUXEL_CHECK(offsetof(luxel_byte_sink, owner) == 8, "luxel_byte_sink.owner");
LUXEL_CHECK(sizeof(luxel_fault_sink) == 16, "size of luxel_fault_sink");
LUXEL_CHECK(_Alignof(luxel_fault_sink) == 8, "alignment of luxel_fault_sink");
LUXEL_CHECK(offsetof(luxel_fault_sink, take) == 0, "luxel_fault_sink.take");
LUXEL_CHECK(offsetof(luxel_fault_sink, owner) == 8, "luxel_fault_sink.owner");
LUXEL_CHECK(sizeof(luxel_ray) == 56, "size of luxel_ray");
LUXEL_CHECK(_Alignof(luxel_ray) == 8, "alignment of luxel_ray");
LUXEL_CHECK(offsetof(luxel_ray, o) == 0, "luxel_ray.o");
LUXEL_CHECK(offsetof(luxel_ray, d) == 24, "luxel_ray.d");
LUXEL_CHECK(offsetof(luxel_ray, t_max) == 48, "luxel_ray.t_max");
LUXEL_CHECK(sizeof(luxel_bounds) == 48, "size of luxel_bounds");
LUXEL_CHECK(_Alignof(luxel_bounds) == 8, "alignment of luxel_bounds");
LUXEL_CHECK(offsetof(luxel_bounds, min) == 0, "luxel_bounds.min");
LUXEL_CHECK(offsetof(luxel_bounds, max) == 24, "luxel_bounds.max");
LUXEL_CHECK(sizeof(luxel_complex_ior) == 32, "size of luxel_complex_ior");
LUXEL_CHECK(_Alignof(luxel_complex_ior) == 16, "alignment of luxel_complex_ior");
LUXEL_CHECK(offsetof(luxel_complex_ior, eta) == 0, "luxel_complex_ior.eta");
LUXEL_CHECK(offsetof(luxel_complex_ior, k) == 16, "luxel_complex_ior.k");
LUXEL_CHECK(sizeof(luxel_emission) == 32, "size of luxel_emission");
LUXEL_CHECK(_Alignof(luxel_emission) == 16, "alignment of luxel_emission");
LUXEL_CHECK(offsetof(luxel_emission, spectrum) == 0, "luxel_emission.spectrum");
LUXEL_CHECK(offsetof(luxel_emission, quantity) == 16, "luxel_emission.quantity");
LUXEL_CHECK(sizeof(luxel_look) == 72, "size of luxel_look");
LUXEL_CHECK(_Alignof(luxel_look) == 8, "alignment of luxel_look");
LUXEL_CHECK(offsetof(luxel_look, from) == 0, "luxel_look.from");
LUXEL_CHECK(offsetof(luxel_look, to) == 24, "luxel_look.to");
LUXEL_CHECK(offsetof(luxel_look, up) == 48, "luxel_look.up");
LUXEL_CHECK(sizeof(luxel_wavelengths) == 32, "size of luxel_wavelengths");
LUXEL_CHECK(_Alignof(luxel_wavelengths) == 16, "alignment of luxel_wavelengths");
LUXEL_CHECK(offsetof(luxel_wavelengths, lambda) == 0, "luxel_wavelengths.lambda");
LUXEL_CHECK(offsetof(luxel_wavelengths, pdf) == 16, "luxel_wavelengths.pdf");
LUXEL_CHECK(sizeof(luxel_hit) == 32, "size of luxel_hit");
LUXEL_CHECK(_Alignof(luxel_hit) == 8, "alignment of luxel_hit");
LUXEL_CHECK(offsetof(luxel_hit, t) == 0, "luxel_hit.t");
LUXEL_CHECK(offsetof(luxel_hit, at) == 8, "luxel_hit.at");
LUXEL_CHECK(offsetof(luxel_hit, face) == 24, "luxel_hit.face");
LUXEL_CHECK(sizeof(luxel_surface) == 160, "size of luxel_surface");
LUXEL_CHECK(_Alignof(luxel_surface) == 8, "alignment of luxel_surface");
LUXEL_CHECK(offsetof(luxel_surface, p) == 0, "luxel_surface.p");
LUXEL_CHECK(offsetof(luxel_surface, p_err) == 24, "luxel_surface.p_err");
LUXEL_CHECK(offsetof(luxel_surface, ng) == 48, "luxel_surface.ng");
LUXEL_CHECK(offsetof(luxel_surface, ns) == 72, "luxel_surface.ns");
LUXEL_CHECK(offsetof(luxel_surface, uv) == 96, "luxel_surface.uv");
LUXEL_CHECK(offsetof(luxel_surface, dp_du) == 112, "luxel_surface.dp_du");
LUXEL_CHECK(offsetof(luxel_surface, dp_dv) == 136, "luxel_surface.dp_dv");
LUXEL_CHECK(sizeof(luxel_shape_sample) == 168, "size of luxel_shape_sample");
LUXEL_CHECK(_Alignof(luxel_shape_sample) == 8, "alignment of luxel_shape_sample");
LUXEL_CHECK(offsetof(luxel_shape_sample, surface) == 0, "luxel_shape_sample.surface");
LUXEL_CHECK(offsetof(luxel_shape_sample, pdf) == 160, "luxel_shape_sample.pdf");
LUXEL_CHECK(sizeof(luxel_parallelogram) == 72, "size of luxel_parallelogram");
LUXEL_CHECK(_Alignof(luxel_parallelogram) == 8, "alignment of luxel_parallelogram");
LUXEL_CHECK(offsetof(luxel_parallelogram, centre) == 0, "luxel_parallelogram.centre");
LUXEL_CHECK(offsetof(luxel_parallelogram, u) == 24, "luxel_parallelogram.u");
LUXEL_CHECK(offsetof(luxel_parallelogram, v) == 48, "luxel_parallelogram.v");
LUXEL_CHECK(sizeof(luxel_normal_derivatives) == 48, "size of luxel_normal_derivatives");
LUXEL_CHECK(_Alignof(luxel_normal_derivatives) == 8, "alignment of luxel_normal_derivatives");
LUXEL_CHECK(offsetof(luxel_normal_derivatives, dn_du) == 0, "luxel_normal_derivatives.dn_du");
LUXEL_CHECK(offsetof(luxel_normal_derivatives, dn_dv) == 24, "luxel_normal_derivatives.dn_dv");
LUXEL_CHECK(sizeof(luxel_eval) == 32, "size of luxel_eval");
LUXEL_CHECK(_Alignof(luxel_eval) == 16, "alignment of luxel_eval");
LUXEL_CHECK(offsetof(luxel_eval, f) == 0, "luxel_eval.f");
LUXEL_CHECK(offsetof(luxel_eval, pdf) == 16, "luxel_eval.pdf");
LUXEL_CHECK(sizeof(luxel_sample) == 48, "size of luxel_sample");
LUXEL_CHECK(_Alignof(luxel_sample) == 16, "alignment of luxel_sample");
LUXEL_CHECK(offsetof(luxel_sample, weight) == 0, "luxel_sample.weight");
LUXEL_CHECK(offsetof(luxel_sample, wi) == 16, "luxel_sample.wi");
LUXEL_CHECK(offsetof(luxel_sample, pdf) == 28, "luxel_sample.pdf");
LUXEL_CHECK(offsetof(luxel_sample, eta) == 32, "luxel_sample.eta");
LUXEL_CHECK(offsetof(luxel_sample, lobe) == 36, "luxel_sample.lobe");
LUXEL_CHECK(sizeof(luxel_texture_point) == 64, "size of luxel_texture_point");
LUXEL_CHECK(_Alignof(luxel_texture_point) == 16, "alignment of luxel_texture_point");
LUXEL_CHECK(offsetof(luxel_texture_point, p) == 0, "luxel_texture_point.p");
LUXEL_CHECK(offsetof(luxel_texture_point, uv) == 24, "luxel_texture_point.uv");
LUXEL_CHECK(offsetof(luxel_texture_point, lambda) == 32, "luxel_texture_point.lambda");
LUXEL_CHECK(sizeof(luxel_light_query) == 32, "size of luxel_light_query");
LUXEL_CHECK(_Alignof(luxel_light_query) == 8, "alignment of luxel_light_query");
LUXEL_CHECK(offsetof(luxel_light_query, p) == 0, "luxel_light_query.p");
LUXEL_CHECK(offsetof(luxel_light_query, u) == 24, "luxel_light_query.u");
LUXEL_CHECK(sizeof(luxel_light_sample) == 64, "size of luxel_light_sample");
LUXEL_CHECK(_Alignof(luxel_light_sample) == 16, "alignment of luxel_light_sample");
LUXEL_CHECK(offsetof(luxel_light_sample, le) == 0, "luxel_light_sample.le");
LUXEL_CHECK(offsetof(luxel_light_sample, wi) == 16, "luxel_light_sample.wi");
LUXEL_CHECK(offsetof(luxel_light_sample, distance) == 40, "luxel_light_sample.distance");
LUXEL_CHECK(offsetof(luxel_light_sample, pdf) == 48, "luxel_light_sample.pdf");
LUXEL_CHECK(offsetof(luxel_light_sample, delta) == 52, "luxel_light_sample.delta");
LUXEL_CHECK(sizeof(luxel_escaped) == 32, "size of luxel_escaped");
LUXEL_CHECK(_Alignof(luxel_escaped) == 16, "alignment of luxel_escaped");
LUXEL_CHECK(offsetof(luxel_escaped, le) == 0, "luxel_escaped.le");
LUXEL_CHECK(offsetof(luxel_escaped, pdf) == 16, "luxel_escaped.pdf");
LUXEL_CHECK(sizeof(luxel_free_flight) == 32, "size of luxel_free_flight");
LUXEL_CHECK(_Alignof(luxel_free_flight) == 16, "alignment of luxel_free_flight");
LUXEL_CHECK(offsetof(luxel_free_flight, t) == 0, "luxel_free_flight.t");
LUXEL_CHECK(offsetof(luxel_free_flight, weight) == 16, "luxel_free_flight.weight");
LUXEL_CHECK(sizeof(luxel_raster) == 8, "size of luxel_raster");
LUXEL_CHECK(_Alignof(luxel_raster) == 4, "alignment of luxel_raster");
LUXEL_CHECK(offsetof(luxel_raster, size) == 0, "luxel_raster.size");
LUXEL_CHECK(sizeof(luxel_camera_ray) == 64, "size of luxel_camera_ray");
LUXEL_CHECK(_Alignof(luxel_camera_ray) == 8, "alignment of luxel_camera_ray");
LUXEL_CHECK(offsetof(luxel_camera_ray, ray) == 0, "luxel_camera_ray.ray");
LUXEL_CHECK(offsetof(luxel_camera_ray, weight) == 56, "luxel_camera_ray.weight");
LUXEL_CHECK(sizeof(luxel_sample_at) == 12, "size of luxel_sample_at");
LUXEL_CHECK(_Alignof(luxel_sample_at) == 4, "alignment of luxel_sample_at");
LUXEL_CHECK(offsetof(luxel_sample_at, stream) == 0, "luxel_sample_at.stream");
LUXEL_CHECK(offsetof(luxel_sample_at, index) == 4, "luxel_sample_at.index");
LUXEL_CHECK(offsetof(luxel_sample_at, dimension) == 8, "luxel_sample_at.dimension");
LUXEL_CHECK(sizeof(luxel_sight) == 80, "size of luxel_sight");
LUXEL_CHECK(_Alignof(luxel_sight) == 16, "alignment of luxel_sight");
LUXEL_CHECK(offsetof(luxel_sight, ray) == 0, "luxel_sight.ray");
LUXEL_CHECK(offsetof(luxel_sight, pixel) == 56, "luxel_sight.pixel");
LUXEL_CHECK(offsetof(luxel_sight, f_we) == 64, "luxel_sight.f_we");
LUXEL_CHECK(sizeof(luxel_maybe_sight) == 96, "size of luxel_maybe_sight");
LUXEL_CHECK(_Alignof(luxel_maybe_sight) == 16, "alignment of luxel_maybe_sight");
LUXEL_CHECK(offsetof(luxel_maybe_sight, given) == 0, "luxel_maybe_sight.given");
LUXEL_CHECK(offsetof(luxel_maybe_sight, value) == 16, "luxel_maybe_sight.value");
LUXEL_CHECK(sizeof(luxel_job) == 176, "size of luxel_job");
LUXEL_CHECK(_Alignof(luxel_job) == 16, "alignment of luxel_job");
LUXEL_CHECK(offsetof(luxel_job, ray) == 0, "luxel_job.ray");
LUXEL_CHECK(offsetof(luxel_job, beta) == 64, "luxel_job.beta");
LUXEL_CHECK(offsetof(luxel_job, sight) == 80, "luxel_job.sight");
LUXEL_CHECK(sizeof(luxel_direct) == 96, "size of luxel_direct");
LUXEL_CHECK(_Alignof(luxel_direct) == 16, "alignment of luxel_direct");
LUXEL_CHECK(offsetof(luxel_direct, ray) == 0, "luxel_direct.ray");
LUXEL_CHECK(offsetof(luxel_direct, f_le) == 64, "luxel_direct.f_le");
LUXEL_CHECK(offsetof(luxel_direct, pdf) == 80, "luxel_direct.pdf");
LUXEL_CHECK(offsetof(luxel_direct, f_pdf) == 84, "luxel_direct.f_pdf");
LUXEL_CHECK(sizeof(luxel_scatter) == 48, "size of luxel_scatter");
LUXEL_CHECK(_Alignof(luxel_scatter) == 16, "alignment of luxel_scatter");
LUXEL_CHECK(offsetof(luxel_scatter, weight) == 0, "luxel_scatter.weight");
LUXEL_CHECK(offsetof(luxel_scatter, wi) == 16, "luxel_scatter.wi");
LUXEL_CHECK(offsetof(luxel_scatter, pdf) == 40, "luxel_scatter.pdf");
LUXEL_CHECK(offsetof(luxel_scatter, eta) == 44, "luxel_scatter.eta");
LUXEL_CHECK(sizeof(luxel_maybe_direct) == 112, "size of luxel_maybe_direct");
LUXEL_CHECK(_Alignof(luxel_maybe_direct) == 16, "alignment of luxel_maybe_direct");
LUXEL_CHECK(offsetof(luxel_maybe_direct, given) == 0, "luxel_maybe_direct.given");
LUXEL_CHECK(offsetof(luxel_maybe_direct, value) == 16, "luxel_maybe_direct.value");
LUXEL_CHECK(sizeof(luxel_maybe_scatter) == 64, "size of luxel_maybe_scatter");
LUXEL_CHECK(_Alignof(luxel_maybe_scatter) == 16, "alignment of luxel_maybe_scatter");
LUXEL_CHECK(offsetof(luxel_maybe_scatter, given) == 0, "luxel_maybe_scatter.given");
LUXEL_CHECK(offsetof(luxel_maybe_scatter, value) == 16, "luxel_maybe_scatter.value");
LUXEL_CHECK(sizeof(luxel_arrival) == 512, "size of luxel_arrival");
LUXEL_CHECK(_Alignof(luxel_arrival) == 16, "alignment of luxel_arrival");
LUXEL_CHECK(offsetof(luxel_arrival, kind) == 0, "luxel_arrival.kind");
LUXEL_CHECK(offsetof(luxel_arrival, p) == 8, "luxel_arrival.p");
LUXEL_CHECK(offsetof(luxel_arrival, p_err) == 32, "luxel_arrival.p_err");
LUXEL_CHECK(offsetof(luxel_arrival, ng) == 56, "luxel_arrival.ng");
LUXEL_CHECK(offsetof(luxel_arrival, ns) == 80, "luxel_arrival.ns");
LUXEL_CHECK(offsetof(luxel_arrival, lift) == 104, "luxel_arrival.lift");
LUXEL_CHECK(offsetof(luxel_arrival, uv) == 128, "luxel_arrival.uv");
LUXEL_CHECK(offsetof(luxel_arrival, t) == 136, "luxel_arrival.t");
LUXEL_CHECK(offsetof(luxel_arrival, wo) == 144, "luxel_arrival.wo");
LUXEL_CHECK(offsetof(luxel_arrival, material) == 168, "luxel_arrival.material");
LUXEL_CHECK(offsetof(luxel_arrival, steps) == 172, "luxel_arrival.steps");
LUXEL_CHECK(offsetof(luxel_arrival, le) == 176, "luxel_arrival.le");
LUXEL_CHECK(offsetof(luxel_arrival, le_pdf) == 192, "luxel_arrival.le_pdf");
LUXEL_CHECK(offsetof(luxel_arrival, glow) == 208, "luxel_arrival.glow");
LUXEL_CHECK(offsetof(luxel_arrival, direct) == 224, "luxel_arrival.direct");
LUXEL_CHECK(offsetof(luxel_arrival, scatter) == 336, "luxel_arrival.scatter");
LUXEL_CHECK(offsetof(luxel_arrival, sight) == 400, "luxel_arrival.sight");
LUXEL_CHECK(offsetof(luxel_arrival, curvature) == 496, "luxel_arrival.curvature");
LUXEL_CHECK(sizeof(luxel_lane) == 560, "size of luxel_lane");
LUXEL_CHECK(_Alignof(luxel_lane) == 16, "alignment of luxel_lane");
LUXEL_CHECK(offsetof(luxel_lane, at) == 0, "luxel_lane.at");
LUXEL_CHECK(offsetof(luxel_lane, l) == 512, "luxel_lane.l");
LUXEL_CHECK(offsetof(luxel_lane, glow) == 528, "luxel_lane.glow");
LUXEL_CHECK(offsetof(luxel_lane, numbers) == 544, "luxel_lane.numbers");
LUXEL_CHECK(sizeof(luxel_onward) == 64, "size of luxel_onward");
LUXEL_CHECK(_Alignof(luxel_onward) == 8, "alignment of luxel_onward");
LUXEL_CHECK(offsetof(luxel_onward, ray) == 0, "luxel_onward.ray");
LUXEL_CHECK(offsetof(luxel_onward, lane) == 56, "luxel_onward.lane");
LUXEL_CHECK(sizeof(luxel_shadow) == 80, "size of luxel_shadow");
LUXEL_CHECK(_Alignof(luxel_shadow) == 16, "alignment of luxel_shadow");
LUXEL_CHECK(offsetof(luxel_shadow, ray) == 0, "luxel_shadow.ray");
LUXEL_CHECK(offsetof(luxel_shadow, lane) == 56, "luxel_shadow.lane");
LUXEL_CHECK(offsetof(luxel_shadow, pixel) == 60, "luxel_shadow.pixel");
LUXEL_CHECK(offsetof(luxel_shadow, l) == 64, "luxel_shadow.l");
LUXEL_CHECK(sizeof(luxel_scene_sphere) == 32, "size of luxel_scene_sphere");
LUXEL_CHECK(_Alignof(luxel_scene_sphere) == 8, "alignment of luxel_scene_sphere");
LUXEL_CHECK(offsetof(luxel_scene_sphere, centre) == 0, "luxel_scene_sphere.centre");
LUXEL_CHECK(offsetof(luxel_scene_sphere, radius) == 24, "luxel_scene_sphere.radius");
LUXEL_CHECK(sizeof(luxel_triangles) == 152, "size of luxel_triangles");
LUXEL_CHECK(_Alignof(luxel_triangles) == 8, "alignment of luxel_triangles");
LUXEL_CHECK(offsetof(luxel_triangles, centre) == 0, "luxel_triangles.centre");
LUXEL_CHECK(offsetof(luxel_triangles, points) == 24, "luxel_triangles.points");
LUXEL_CHECK(offsetof(luxel_triangles, indices) == 40, "luxel_triangles.indices");
LUXEL_CHECK(offsetof(luxel_triangles, normals) == 56, "luxel_triangles.normals");
LUXEL_CHECK(offsetof(luxel_triangles, uvs) == 72, "luxel_triangles.uvs");
LUXEL_CHECK(offsetof(luxel_triangles, colors) == 88, "luxel_triangles.colors");
LUXEL_CHECK(offsetof(luxel_triangles, later_times) == 104, "luxel_triangles.later_times");
LUXEL_CHECK(offsetof(luxel_triangles, later_points) == 120, "luxel_triangles.later_points");
LUXEL_CHECK(offsetof(luxel_triangles, later_normals) == 136, "luxel_triangles.later_normals");
LUXEL_CHECK(sizeof(luxel_built) == 16, "size of luxel_built");
LUXEL_CHECK(_Alignof(luxel_built) == 8, "alignment of luxel_built");
LUXEL_CHECK(offsetof(luxel_built, address) == 0, "luxel_built.address");
LUXEL_CHECK(offsetof(luxel_built, owner) == 8, "luxel_built.owner");
LUXEL_CHECK(sizeof(luxel_import_value) == 128, "size of luxel_import_value");
LUXEL_CHECK(_Alignof(luxel_import_value) == 8, "alignment of luxel_import_value");
LUXEL_CHECK(offsetof(luxel_import_value, tag) == 0, "luxel_import_value.tag");
LUXEL_CHECK(offsetof(luxel_import_value, index) == 4, "luxel_import_value.index");
LUXEL_CHECK(offsetof(luxel_import_value, numbers) == 8, "luxel_import_value.numbers");
LUXEL_CHECK(offsetof(luxel_import_value, text) == 80, "luxel_import_value.text");
LUXEL_CHECK(offsetof(luxel_import_value, table) == 96, "luxel_import_value.table");
LUXEL_CHECK(offsetof(luxel_import_value, bytes) == 112, "luxel_import_value.bytes");
LUXEL_CHECK(sizeof(luxel_param) == 184, "size of luxel_param");
LUXEL_CHECK(_Alignof(luxel_param) == 8, "alignment of luxel_param");
LUXEL_CHECK(offsetof(luxel_param, name) == 0, "luxel_param.name");
LUXEL_CHECK(offsetof(luxel_param, doc) == 16, "luxel_param.doc");
LUXEL_CHECK(offsetof(luxel_param, ty) == 32, "luxel_param.ty");
LUXEL_CHECK(offsetof(luxel_param, role) == 36, "luxel_param.role");
LUXEL_CHECK(offsetof(luxel_param, unit) == 40, "luxel_param.unit");
LUXEL_CHECK(offsetof(luxel_param, preset) == 56, "luxel_param.preset");
LUXEL_CHECK(offsetof(luxel_param, flags) == 60, "luxel_param.flags");
LUXEL_CHECK(offsetof(luxel_param, numbers) == 64, "luxel_param.numbers");
LUXEL_CHECK(offsetof(luxel_param, text) == 96, "luxel_param.text");
LUXEL_CHECK(offsetof(luxel_param, min) == 112, "luxel_param.min");
LUXEL_CHECK(offsetof(luxel_param, max) == 120, "luxel_param.max");
LUXEL_CHECK(offsetof(luxel_param, choices) == 128, "luxel_param.choices");
LUXEL_CHECK(offsetof(luxel_param, group) == 144, "luxel_param.group");
LUXEL_CHECK(offsetof(luxel_param, deprecated) == 160, "luxel_param.deprecated");
LUXEL_CHECK(offsetof(luxel_param, offset) == 176, "luxel_param.offset");
LUXEL_CHECK(sizeof(luxel_requests) == 64, "size of luxel_requests");
LUXEL_CHECK(_Alignof(luxel_requests) == 8, "alignment of luxel_requests");
LUXEL_CHECK(offsetof(luxel_requests, rays) == 0, "luxel_requests.rays");
LUXEL_CHECK(offsetof(luxel_requests, shadows) == 32, "luxel_requests.shadows");
LUXEL_CHECK(sizeof(luxel_ask) == 32, "size of luxel_ask");
LUXEL_CHECK(_Alignof(luxel_ask) == 8, "alignment of luxel_ask");
LUXEL_CHECK(offsetof(luxel_ask, lane) == 0, "luxel_ask.lane");
LUXEL_CHECK(offsetof(luxel_ask, l) == 8, "luxel_ask.l");
LUXEL_CHECK(offsetof(luxel_ask, glow) == 16, "luxel_ask.glow");
LUXEL_CHECK(offsetof(luxel_ask, requests) == 24, "luxel_ask.requests");
LUXEL_CHECK(sizeof(luxel_material_ref) == 16, "size of luxel_material_ref");
LUXEL_CHECK(_Alignof(luxel_material_ref) == 8, "alignment of luxel_material_ref");
LUXEL_CHECK(offsetof(luxel_material_ref, table) == 0, "luxel_material_ref.table");
LUXEL_CHECK(offsetof(luxel_material_ref, at) == 8, "luxel_material_ref.at");
LUXEL_CHECK(sizeof(luxel_phase_ref) == 16, "size of luxel_phase_ref");
LUXEL_CHECK(_Alignof(luxel_phase_ref) == 8, "alignment of luxel_phase_ref");
LUXEL_CHECK(offsetof(luxel_phase_ref, table) == 0, "luxel_phase_ref.table");
LUXEL_CHECK(offsetof(luxel_phase_ref, at) == 8, "luxel_phase_ref.at");
LUXEL_CHECK(sizeof(luxel_texture_ref) == 16, "size of luxel_texture_ref");
LUXEL_CHECK(_Alignof(luxel_texture_ref) == 8, "alignment of luxel_texture_ref");
LUXEL_CHECK(offsetof(luxel_texture_ref, table) == 0, "luxel_texture_ref.table");
LUXEL_CHECK(offsetof(luxel_texture_ref, at) == 8, "luxel_texture_ref.at");
LUXEL_CHECK(sizeof(luxel_sampler_ref) == 16, "size of luxel_sampler_ref");
LUXEL_CHECK(_Alignof(luxel_sampler_ref) == 8, "alignment of luxel_sampler_ref");
LUXEL_CHECK(offsetof(luxel_sampler_ref, table) == 0, "luxel_sampler_ref.table");
LUXEL_CHECK(offsetof(luxel_sampler_ref, at) == 8, "luxel_sampler_ref.at");
LUXEL_CHECK(sizeof(luxel_samples_ref) == 32, "size of luxel_samples_ref");
LUXEL_CHECK(_Alignof(luxel_samples_ref) == 8, "alignment of luxel_samples_ref");
LUXEL_CHECK(offsetof(luxel_samples_ref, source) == 0, "luxel_samples_ref.source");
LUXEL_CHECK(offsetof(luxel_samples_ref, next) == 16, "luxel_samples_ref.next");
LUXEL_CHECK(sizeof(luxel_shape_ref) == 16, "size of luxel_shape_ref");
LUXEL_CHECK(_Alignof(luxel_shape_ref) == 8, "alignment of luxel_shape_ref");
LUXEL_CHECK(offsetof(luxel_shape_ref, table) == 0, "luxel_shape_ref.table");
LUXEL_CHECK(offsetof(luxel_shape_ref, at) == 8, "luxel_shape_ref.at");
LUXEL_CHECK(sizeof(luxel_host_ref) == 16, "size of luxel_host_ref");
LUXEL_CHECK(_Alignof(luxel_host_ref) == 8, "alignment of luxel_host_ref");
LUXEL_CHECK(offsetof(luxel_host_ref, table) == 0, "luxel_host_ref.table");
LUXEL_CHECK(offsetof(luxel_host_ref, at) == 8, "luxel_host_ref.at");
LUXEL_CHECK(sizeof(luxel_round_ref) == 32, "size of luxel_round_ref");
LUXEL_CHECK(_Alignof(luxel_round_ref) == 8, "alignment of luxel_round_ref");
LUXEL_CHECK(offsetof(luxel_round_ref, host) == 0, "luxel_round_ref.host");
LUXEL_CHECK(offsetof(luxel_round_ref, sampler) == 16, "luxel_round_ref.sampler");
LUXEL_CHECK(sizeof(luxel_lanes) == 40, "size of luxel_lanes");
LUXEL_CHECK(_Alignof(luxel_lanes) == 8, "alignment of luxel_lanes");
LUXEL_CHECK(offsetof(luxel_lanes, lanes) == 0, "luxel_lanes.lanes");
LUXEL_CHECK(offsetof(luxel_lanes, n_lanes) == 8, "luxel_lanes.n_lanes");
LUXEL_CHECK(offsetof(luxel_lanes, states) == 16, "luxel_lanes.states");
LUXEL_CHECK(offsetof(luxel_lanes, arrived) == 24, "luxel_lanes.arrived");
LUXEL_CHECK(sizeof(luxel_paths_ref) == 24, "size of luxel_paths_ref");
LUXEL_CHECK(_Alignof(luxel_paths_ref) == 8, "alignment of luxel_paths_ref");
LUXEL_CHECK(offsetof(luxel_paths_ref, table) == 0, "luxel_paths_ref.table");
LUXEL_CHECK(offsetof(luxel_paths_ref, at) == 8, "luxel_paths_ref.at");
LUXEL_CHECK(offsetof(luxel_paths_ref, last_panic) == 16, "luxel_paths_ref.last_panic");
LUXEL_CHECK(sizeof(luxel_picture_job_ref) == 16, "size of luxel_picture_job_ref");
LUXEL_CHECK(_Alignof(luxel_picture_job_ref) == 8, "alignment of luxel_picture_job_ref");
LUXEL_CHECK(offsetof(luxel_picture_job_ref, table) == 0, "luxel_picture_job_ref.table");
LUXEL_CHECK(offsetof(luxel_picture_job_ref, at) == 8, "luxel_picture_job_ref.at");
LUXEL_CHECK(sizeof(luxel_context_ref) == 16, "size of luxel_context_ref");
LUXEL_CHECK(_Alignof(luxel_context_ref) == 8, "alignment of luxel_context_ref");
LUXEL_CHECK(offsetof(luxel_context_ref, table) == 0, "luxel_context_ref.table");
LUXEL_CHECK(offsetof(luxel_context_ref, at) == 8, "luxel_context_ref.at");
LUXEL_CHECK(sizeof(luxel_mesh_sink) == 16, "size of luxel_mesh_sink");
LUXEL_CHECK(_Alignof(luxel_mesh_sink) == 8, "alignment of luxel_mesh_sink");
LUXEL_CHECK(offsetof(luxel_mesh_sink, take) == 0, "luxel_mesh_sink.take");
LUXEL_CHECK(offsetof(luxel_mesh_sink, owner) == 8, "luxel_mesh_sink.owner");
LUXEL_CHECK(sizeof(luxel_import_sink) == 40, "size of luxel_import_sink");
LUXEL_CHECK(_Alignof(luxel_import_sink) == 8, "alignment of luxel_import_sink");
LUXEL_CHECK(offsetof(luxel_import_sink, owner) == 0, "luxel_import_sink.owner");
LUXEL_CHECK(offsetof(luxel_import_sink, node) == 8, "luxel_import_sink.node");
LUXEL_CHECK(offsetof(luxel_import_sink, value) == 16, "luxel_import_sink.value");
LUXEL_CHECK(offsetof(luxel_import_sink, place) == 24, "luxel_import_sink.place");
LUXEL_CHECK(offsetof(luxel_import_sink, warn) == 32, "luxel_import_sink.warn");
LUXEL_CHECK(sizeof(luxel_context_table) == 40, "size of luxel_context_table");
LUXEL_CHECK(_Alignof(luxel_context_table) == 8, "alignment of luxel_context_table");
LUXEL_CHECK(offsetof(luxel_context_table, size) == 0, "luxel_context_table.size");
LUXEL_CHECK(offsetof(luxel_context_table, read) == 8, "luxel_context_table.read");
LUXEL_CHECK(offsetof(luxel_context_table, warn) == 16, "luxel_context_table.warn");
LUXEL_CHECK(offsetof(luxel_context_table, cancelled) == 24, "luxel_context_table.cancelled");
LUXEL_CHECK(offsetof(luxel_context_table, holds) == 32, "luxel_context_table.holds");
LUXEL_CHECK(sizeof(luxel_class) == 104, "size of luxel_class");
LUXEL_CHECK(_Alignof(luxel_class) == 8, "alignment of luxel_class");
LUXEL_CHECK(offsetof(luxel_class, kind) == 0, "luxel_class.kind");
LUXEL_CHECK(offsetof(luxel_class, size) == 4, "luxel_class.size");
LUXEL_CHECK(offsetof(luxel_class, name) == 8, "luxel_class.name");
LUXEL_CHECK(offsetof(luxel_class, doc) == 24, "luxel_class.doc");
LUXEL_CHECK(offsetof(luxel_class, params) == 40, "luxel_class.params");
LUXEL_CHECK(offsetof(luxel_class, prepare) == 56, "luxel_class.prepare");
LUXEL_CHECK(offsetof(luxel_class, check) == 64, "luxel_class.check");
LUXEL_CHECK(offsetof(luxel_class, build) == 72, "luxel_class.build");
LUXEL_CHECK(offsetof(luxel_class, free) == 80, "luxel_class.free");
LUXEL_CHECK(offsetof(luxel_class, shared_offset) == 88, "luxel_class.shared_offset");
LUXEL_CHECK(offsetof(luxel_class, behaviour) == 96, "luxel_class.behaviour");
LUXEL_CHECK(sizeof(luxel_library) == 120, "size of luxel_library");
LUXEL_CHECK(_Alignof(luxel_library) == 8, "alignment of luxel_library");
LUXEL_CHECK(offsetof(luxel_library, magic) == 0, "luxel_library.magic");
LUXEL_CHECK(offsetof(luxel_library, abi_major) == 8, "luxel_library.abi_major");
LUXEL_CHECK(offsetof(luxel_library, abi_minor) == 12, "luxel_library.abi_minor");
LUXEL_CHECK(offsetof(luxel_library, layout_hash) == 16, "luxel_library.layout_hash");
LUXEL_CHECK(offsetof(luxel_library, size) == 24, "luxel_library.size");
LUXEL_CHECK(offsetof(luxel_library, name) == 32, "luxel_library.name");
LUXEL_CHECK(offsetof(luxel_library, version) == 48, "luxel_library.version");
LUXEL_CHECK(offsetof(luxel_library, compiler) == 64, "luxel_library.compiler");
LUXEL_CHECK(offsetof(luxel_library, panic) == 80, "luxel_library.panic");
LUXEL_CHECK(offsetof(luxel_library, classes) == 88, "luxel_library.classes");
LUXEL_CHECK(offsetof(luxel_library, begin) == 104, "luxel_library.begin");
LUXEL_CHECK(offsetof(luxel_library, last_panic) == 112, "luxel_library.last_panic");

#endif
