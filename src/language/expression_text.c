/* expression_text.c - the text of an expression, gathered from the tokens of its card. */
#include "expression.h"

#include "lower_case.h"

#include <string.h>

/* Tokens k.. on the same line as token k: the first that is not. */
static int end_of_line(const struct dalcs_token *token, int k, int n) {
    const struct dalcs_source_line *line = token[k].line;
    while (k < n && token[k].line == line) {
        k++;
    }
    return k;
}

bool dalcs_expression_text(struct dalcs_arena *arena, const struct dalcs_token *token, int n,
                           struct dalcs_expression_text *text) {
    const int inside = n == 1 && token[0].kind == DALCS_TOKEN_EXPRESSION ? 1 : 0;
    size_t length = 0;
    int n_pieces = 0;
    for (int k = 0; k < n; n_pieces++) {
        const int end = end_of_line(token, k, n);
        length += (size_t)(token[end - 1].offset + token[end - 1].length - token[k].offset) + 1;
        k = end;
    }
    char *low = dalcs_arena_alloc(arena, length + 1, 1);
    struct dalcs_piece *piece = dalcs_arena_alloc(arena, (size_t)n_pieces, sizeof *piece);
    if (low == NULL || piece == NULL) {
        return false;
    }
    int at = 0;
    n_pieces = 0;
    for (int k = 0; k < n; n_pieces++) {
        const int end = end_of_line(token, k, n);
        const struct dalcs_token *last = &token[end - 1];
        low[at] = token[k].after_comma ? ',' : ' '; /* the line before may end with one */
        at += n_pieces > 0;
        piece[n_pieces] = (struct dalcs_piece){token[k].line, at, token[k].offset + inside};
        const int stop = last->offset + last->length - inside;
        for (int p = token[k].offset + inside; p < stop; p++) {
            low[at++] = dalcs_lower(token[k].line->text[p]);
        }
        k = end;
    }
    low[at] = '\0';
    *text = (struct dalcs_expression_text){low, at, piece, n_pieces};
    return true;
}

const struct dalcs_piece *dalcs_expression_piece(const struct dalcs_expression_text *text,
                                                 int begin) {
    int k = text->n_pieces - 1;
    while (k > 0 && text->piece[k].begin > begin) {
        k--;
    }
    return &text->piece[k];
}

struct dalcs_location dalcs_expression_place(const struct dalcs_expression_text *text, int begin,
                                             int length) {
    const struct dalcs_piece *piece = dalcs_expression_piece(text, begin);
    const struct dalcs_token token = {
        .line = piece->line, .offset = piece->offset + begin - piece->begin, .length = length};
    struct dalcs_location where = dalcs_token_location(&token);
    where.length = where.length > 0 ? where.length : 1;
    return where;
}
