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

