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
