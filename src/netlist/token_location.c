/* token_location.c - where a token stands, as a message counts lines and characters. */
#include "netlist.h"

/* Characters (UTF-8 code points) in text[0..bytes-1]. */
static int count_characters(const char *text, int bytes) {
    int n = 0;
    for (int k = 0; k < bytes; k++) {
        n += ((unsigned char)text[k] & 0xC0) != 0x80;
    }
    return n;
}

/* The same up to an offset in a line. */
static int count_before(const struct dalcs_source_line *line, int offset) {
    const int n = offset < line->n_ascii ? offset : line->n_ascii;
    return n + count_characters(line->text + n, offset - n);
}

static struct dalcs_location make_location(const struct dalcs_source_line *line, int offset,
                                           int length) {
    const int before = count_before(line, offset);
    return (struct dalcs_location){.file = line->source->name,
                                   .source_line = line->text,
                                   .line = line->number,
                                   .column = before + 1,
                                   .length = count_before(line, offset + length) - before,
                                   .file_number = line->source->number,
                                   .instance = line->instance,
                                   .included = line->source->included};
}

struct dalcs_location dalcs_token_location(const struct dalcs_token *token) {
    return make_location(token->line, token->offset, token->length);
}

struct dalcs_location dalcs_token_span(const struct dalcs_token *first,
                                       const struct dalcs_token *last) {
    if (last->line != first->line || last->offset < first->offset) {
        return dalcs_token_location(first);
    }
    return make_location(first->line, first->offset, last->offset + last->length - first->offset);
}

struct dalcs_location dalcs_token_end(const struct dalcs_token *token) {
    struct dalcs_location where = make_location(token->line, token->offset + token->length, 0);
    where.length = 1;
    return where;
}
