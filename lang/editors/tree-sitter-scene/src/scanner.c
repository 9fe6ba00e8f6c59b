// What only a look at the rest of the line can tell: a unit after a number or bracket, and the kind
// after the category of an object. On the next line the same word would begin a statement.

#include <stdbool.h>
#include <string.h>

#include "tree_sitter/parser.h"

enum TokenType { UNIT, KIND };

// Longer than every keyword and every known unit.
#define MAX_WORD 8

static const char *const KEYWORDS[] = {
    "let",     "param", "fn",  "for",    "if",     "else",  "include", "import", "use", "place",
    "set",     "assert", "expect", "units", "with", "where", "as",     "in",     "true", "false",
};

// The units that may follow `/` or `*`; `~` stands for µ.
static const char *const UNITS[] = {
    "km", "cm", "mm", "um", "~m", "nm",  "inch", "ft",  "sr",  "ms",  "us", "deg", "rad", "kW", "mW", "W",
    "klx", "lx", "klm", "lm", "kcd", "cd", "nit", "kg", "K",   "J",   "Hz", "m",   "s",   "g",
};

#define COUNT(array) (sizeof(array) / sizeof(*(array)))
#define MICRO 0xB5

static bool is_letter(int32_t c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
static bool is_digit(int32_t c) { return c >= '0' && c <= '9'; }
static bool begins_word(int32_t c) { return is_letter(c) || c == '_'; }
static bool continues_word(int32_t c) { return begins_word(c) || is_digit(c); }
static bool is_blank(int32_t c) { return c == ' ' || c == '\t'; }

static void advance(TSLexer *lexer) { lexer->advance(lexer, false); }

static bool is_one_of(const char *word, const char *const *words, size_t n_words) {
    for (size_t i = 0; i < n_words; i++) {
        if (strcmp(word, words[i]) == 0) return true;
    }
    return false;
}

// Reads letters and more while `continues` says so; keeps the first of them in `word`.
static void read_word(TSLexer *lexer, bool (*continues)(int32_t), char word[MAX_WORD]) {
    size_t length = 0;
    for (; continues(lexer->lookahead); advance(lexer)) {
        char c = lexer->lookahead == MICRO ? '~' : (char)lexer->lookahead;
        if (length < MAX_WORD - 1) word[length] = c;
        length++;
    }
    // A longer word is none of ours.
    word[length < MAX_WORD ? length : 0] = '\0';
}

static bool continues_unit(int32_t c) { return is_letter(c) || c == MICRO; }

// Reads `^2` or `^-1`; says whether it was one. What was not is left to the next token.
static bool read_power(TSLexer *lexer) {
    advance(lexer);
    if (lexer->lookahead == '-') advance(lexer);
    if (!is_digit(lexer->lookahead)) return false;
    advance(lexer);
    return !is_digit(lexer->lookahead) && lexer->lookahead != '.';
}

// Reads `W/m^2/sr`. The first word is open, so that a unit that is misspelt is still one.
static bool scan_unit(TSLexer *lexer, char word[MAX_WORD]) {
    if (!is_letter(lexer->lookahead) && lexer->lookahead != MICRO) return false;
    bool is_micro = lexer->lookahead == MICRO;
    if (is_micro) advance(lexer);
    read_word(lexer, continues_word, word);
    if (!is_micro && is_one_of(word, KEYWORDS, COUNT(KEYWORDS))) return false;
    lexer->result_symbol = UNIT;
    lexer->mark_end(lexer);
    if (lexer->lookahead == '^') {
        if (!read_power(lexer)) return true;
        lexer->mark_end(lexer);
    }
    while (lexer->lookahead == '/' || lexer->lookahead == '*') {
        advance(lexer);
        read_word(lexer, continues_unit, word);
        if (!is_one_of(word, UNITS, COUNT(UNITS)) || continues_word(lexer->lookahead)) return true;
        // Without its power the unit is still one.
        lexer->mark_end(lexer);
        if (lexer->lookahead == '^') {
            if (!read_power(lexer) || continues_word(lexer->lookahead)) return true;
            lexer->mark_end(lexer);
        }
    }
    return true;
}

// Reads `rough.dielectric` if a block follows, perhaps after a label on the same line.
static bool scan_kind(TSLexer *lexer, char word[MAX_WORD]) {
    if (!begins_word(lexer->lookahead)) return false;
    read_word(lexer, continues_word, word);
    if (is_one_of(word, KEYWORDS, COUNT(KEYWORDS))) return false;
    while (lexer->lookahead == '.') {
        advance(lexer);
        if (!begins_word(lexer->lookahead)) return false;
        while (continues_word(lexer->lookahead)) advance(lexer);
    }
    lexer->result_symbol = KIND;
    lexer->mark_end(lexer);
    bool is_apart = is_blank(lexer->lookahead);
    while (is_blank(lexer->lookahead)) advance(lexer);
    if (is_apart && lexer->lookahead == '"') {
        advance(lexer);
        while (lexer->lookahead != '"') {
            if (lexer->eof(lexer) || lexer->lookahead == '\n') return false;
            if (lexer->lookahead == '\\') advance(lexer);
            advance(lexer);
        }
        advance(lexer);
    }
    while (is_blank(lexer->lookahead) || lexer->lookahead == '\r' || lexer->lookahead == '\n') {
        advance(lexer);
    }
    return lexer->lookahead == '{';
}

void *tree_sitter_scene_external_scanner_create(void) { return NULL; }

void tree_sitter_scene_external_scanner_destroy(void *payload) { (void)payload; }

unsigned tree_sitter_scene_external_scanner_serialize(void *payload, char *buffer) {
    (void)payload;
    (void)buffer;
    return 0;
}

void tree_sitter_scene_external_scanner_deserialize(void *payload, const char *buffer, unsigned length) {
    (void)payload;
    (void)buffer;
    (void)length;
}

bool tree_sitter_scene_external_scanner_scan(void *payload, TSLexer *lexer, const bool *valid) {
    (void)payload;
    // While the parser recovers from a mistake everything is valid: then a word is a word.
    if (valid[UNIT] && valid[KIND]) return false;
    char word[MAX_WORD] = {0};
    bool is_apart = is_blank(lexer->lookahead);
    while (is_blank(lexer->lookahead)) lexer->advance(lexer, true);
    if (valid[UNIT]) return scan_unit(lexer, word);
    return valid[KIND] && is_apart && scan_kind(lexer, word);
}
