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

