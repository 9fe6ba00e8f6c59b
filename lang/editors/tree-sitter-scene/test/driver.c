// Reads requests from standard input, one a line, and answers each with a line of JSON:
//   parse FILE          the nodes, as [type, named, start, end, depth, is_error, is_missing]
//   tree FILE           the tree as an S-expression
//   query QUERIES FILE  the captures, as [name, start, end, pattern], in the order of the text
//   edit FILE FROM OLD_END NEW_FILE   whether the edited tree, read again, is that of the new text

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <tree_sitter/api.h>

const TSLanguage *tree_sitter_scene(void);

static char *read_file(const char *path, uint32_t *length) {
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        fprintf(stderr, "%s cannot be read\n", path);
        exit(1);
    }
    fseek(file, 0, SEEK_END);
    *length = (uint32_t)ftell(file);
    rewind(file);
    char *text = malloc(*length + 1);
    if (fread(text, 1, *length, file) != *length) exit(1);
    text[*length] = '\0';
    fclose(file);
    return text;
}

static TSPoint point_at(const char *text, uint32_t at) {
    TSPoint point = {0, 0};
    for (uint32_t i = 0; i < at; i++) {
        if (text[i] == '\n') {
            point.row++;
            point.column = 0;
        } else {
            point.column++;
        }
    }
    return point;
}

static void print_quoted(const char *text) {
    putchar('"');
    for (; *text; text++) {
        if (*text == '"' || *text == '\\') putchar('\\');
        putchar(*text);
    }
    putchar('"');
}

static void print_nodes(TSNode root) {
    TSTreeCursor cursor = ts_tree_cursor_new(root);
    const char *comma = "[";
    for (;;) {
        TSNode node = ts_tree_cursor_current_node(&cursor);
        printf("%s[", comma);
        print_quoted(ts_node_type(node));
        printf(",%d,%u,%u,%u,%d,%d]", ts_node_is_named(node), ts_node_start_byte(node),
               ts_node_end_byte(node), ts_tree_cursor_current_depth(&cursor), ts_node_is_error(node),
               ts_node_is_missing(node));
        comma = ",";
        if (ts_tree_cursor_goto_first_child(&cursor)) continue;
        while (!ts_tree_cursor_goto_next_sibling(&cursor)) {
            if (!ts_tree_cursor_goto_parent(&cursor)) {
                puts("]");
                ts_tree_cursor_delete(&cursor);
                return;
            }
        }
    }
}

static void print_captures(const char *path, TSNode root) {
    uint32_t length, error_at;
    TSQueryError error;
    char *source = read_file(path, &length);
    TSQuery *query = ts_query_new(tree_sitter_scene(), source, length, &error_at, &error);
    if (query == NULL) {
        fprintf(stderr, "%s: error %d at byte %u\n", path, error, error_at);
        exit(1);
    }
    TSQueryCursor *cursor = ts_query_cursor_new();
    ts_query_cursor_exec(cursor, query, root);
    TSQueryMatch match;
    uint32_t index;
    const char *comma = "";
    putchar('[');
    while (ts_query_cursor_next_capture(cursor, &match, &index)) {
        const char *name = ts_query_capture_name_for_id(query, match.captures[index].index, &length);
        TSNode node = match.captures[index].node;
        printf("%s[", comma);
        print_quoted(name);
        printf(",%u,%u,%u]", ts_node_start_byte(node), ts_node_end_byte(node), match.pattern_index);
        comma = ",";
    }
    puts("]");
    ts_query_cursor_delete(cursor);
    ts_query_delete(query);
    free(source);
}

static TSTree *parse(TSParser *parser, const TSTree *old, const char *text, uint32_t length) {
    return ts_parser_parse_string(parser, old, text, length);
}

// Whether an edit and reading on gives what reading anew gives.
static void print_edit(TSParser *parser, TSTree *tree, const char *old, char *words[]) {
    uint32_t start = (uint32_t)atoi(words[2]), old_end = (uint32_t)atoi(words[3]), length;
    char *text = read_file(words[4], &length);
    uint32_t new_end = old_end + length - (uint32_t)strlen(old);
    TSInputEdit edit = {
        start, old_end, new_end, point_at(old, start), point_at(old, old_end), point_at(text, new_end),
    };
    ts_tree_edit(tree, &edit);
    TSTree *again = parse(parser, tree, text, length), *anew = parse(parser, NULL, text, length);
    char *a = ts_node_string(ts_tree_root_node(again)), *b = ts_node_string(ts_tree_root_node(anew));
    puts(strcmp(a, b) == 0 ? "true" : "false");
    free(a);
    free(b);
    ts_tree_delete(again);
    ts_tree_delete(anew);
    free(text);
}

int main(void) {
    static char line[1 << 16];
    TSParser *parser = ts_parser_new();
    if (!ts_parser_set_language(parser, tree_sitter_scene())) return 1;
    while (fgets(line, sizeof line, stdin)) {
        char *words[5] = {NULL};
        size_t n_words = 0;
        for (char *word = strtok(line, "\t\n"); word && n_words < 5; word = strtok(NULL, "\t\n")) {
            words[n_words++] = word;
        }
        int is_query = strcmp(words[0], "query") == 0;
        uint32_t length;
        char *text = read_file(words[is_query ? 2 : 1], &length);
        TSTree *tree = parse(parser, NULL, text, length);
        TSNode root = ts_tree_root_node(tree);
        if (is_query) {
            print_captures(words[1], root);
        } else if (strcmp(words[0], "tree") == 0) {
            char *string = ts_node_string(root);
            print_quoted(string);
            puts("");
            free(string);
        } else if (strcmp(words[0], "edit") == 0) {
            print_edit(parser, tree, text, words);
        } else {
            print_nodes(root);
        }
        ts_tree_delete(tree);
        free(text);
    }
    ts_parser_delete(parser);
    return 0;
}
