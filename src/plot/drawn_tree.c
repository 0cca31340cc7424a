/* drawn_tree.c - names in what is drawn, and the tree of its operations. */
#include "drawn_tree.h"

#include "names.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

long dalcs_signal_find_column(const struct dalcs_waveforms *waveforms, const char *name) {
    for (size_t c = 0; c < waveforms->n_columns; c++) {
        if (strcasecmp(waveforms->name[c], name) == 0) {
            return (long)c;
        }
    }
    return -1;
}

/* The other names that ngspice has for the current i(x). */
static long find_current(const struct dalcs_waveforms *waveforms, const char *name) {
    static const struct {
        const char *before, *after;
    } form[] = {{"", "#branch"}, {"@", "[i]"}, {"@", "[id]"}, {"i(@", "[i])"}, {"i(@", "[id])"}};

    size_t length = strlen(name);
    char other[128];
    if (length < 4 || length > sizeof other - 16 || strncasecmp(name, "i(", 2) != 0) {
        return -1;
    }
    for (size_t i = 0; i < sizeof form / sizeof form[0]; i++) {
        snprintf(other, sizeof other, "%s%.*s%s", form[i].before, (int)length - 3, name + 2,
                 form[i].after);
        long column = dalcs_signal_find_column(waveforms, other);
        if (column >= 0) {
            return column;
        }
    }
    return -1;
}

static bool is_ground(const char *node) {
    return strcmp(node, "0") == 0 || strcasecmp(node, "gnd") == 0;
}

static enum dalcs_status refuse_name(struct dalcs_drawn_parser *parser, const char *name) {
    const struct dalcs_waveforms *w = parser->waveforms;
    const char *nearest = dalcs_names_nearest_of(w->name, w->n_columns, name);
    struct dalcs_names names = {0};
    const char *all = NULL;
    for (size_t c = 0; c < w->n_columns && c <= DALCS_DRAWN_NAMES; c++) {
        if (dalcs_names_find(&names, w->name[c]) < 0 &&
            dalcs_names_add(&names, w->name[c], 0) != DALCS_OK) {
            break;
        }
    }
    all = dalcs_names_join(&names, DALCS_DRAWN_NAMES, parser->arena);
    const char *hint = all ? dalcs_arena_printf(parser->arena, "the file has %s", all) : NULL;
    dalcs_names_finish(&names);
    dalcs_diag_add(parser->diag, DALCS_ERROR, NULL, hint, "there is no signal '%s'%s%s%s", name,
                   nearest ? "; did you mean '" : "", nearest ? nearest : "", nearest ? "'?" : "");
    return DALCS_E_OPTION;
}

enum dalcs_status dalcs_drawn_make(struct dalcs_drawn_parser *parser,
                                   const struct dalcs_signal_node *value,
                                   const struct dalcs_signal_node **node) {
    struct dalcs_signal_node *made = dalcs_arena_alloc(parser->arena, 1, sizeof *made);
    if (!made) {
        return DALCS_E_NOMEM;
    }
    *made = *value;
    *node = made;
    return DALCS_OK;
}

static bool is_number(const struct dalcs_signal_node *node) {
    return dalcs_dimension_equal(node->dimension, (struct dalcs_dimension){0});
}

/* A plain number takes the unit of what it is added to; two different units give none. */
static struct dalcs_dimension sum_dimension(const struct dalcs_signal_node *a,
                                            const struct dalcs_signal_node *b) {
    if (is_number(a) || dalcs_dimension_equal(a->dimension, b->dimension)) {
        return b->dimension;
    }
    return is_number(b) ? a->dimension : (struct dalcs_dimension){0};
}

enum dalcs_status dalcs_drawn_combine(struct dalcs_drawn_parser *parser,
                                      enum dalcs_drawn_operation operation,
                                      const struct dalcs_signal_node *left,
                                      const struct dalcs_signal_node *right,
                                      const struct dalcs_signal_node **node) {
    struct dalcs_signal_node value = {.operation = operation, .left = left, .right = right};
    if (operation == DALCS_DRAWN_ADD || operation == DALCS_DRAWN_SUBTRACT) {
        value.dimension = sum_dimension(left, right);
    } else if (operation == DALCS_DRAWN_MULTIPLY || operation == DALCS_DRAWN_DIVIDE) {
        value.dimension = dalcs_dimension_multiply(left->dimension, right->dimension,
                                                   operation == DALCS_DRAWN_MULTIPLY ? 1 : -1);
    } else if (operation == DALCS_DRAWN_NEGATE || operation == DALCS_DRAWN_ABS) {
        value.dimension = left->dimension;
    } else if (operation == DALCS_DRAWN_DB) {
        value.dimension.decibel = true;
    }
    return dalcs_drawn_make(parser, &value, node);
}

enum dalcs_status dalcs_drawn_column(struct dalcs_drawn_parser *parser, size_t column,
                                     const struct dalcs_signal_node **node) {
    const struct dalcs_signal_node value = {.operation = DALCS_DRAWN_COLUMN,
                                            .column = column,
                                            .dimension = parser->waveforms->dimension[column]};
    return dalcs_drawn_make(parser, &value, node);
}

/* The voltage of a node against ground. */
static enum dalcs_status take_node(struct dalcs_drawn_parser *parser, const char *node_name,
                                   const struct dalcs_signal_node **node) {
    if (is_ground(node_name)) {
        const struct dalcs_signal_node zero = {.operation = DALCS_DRAWN_NUMBER,
                                               .dimension = {.volt = 1}};
        return dalcs_drawn_make(parser, &zero, node);
    }
    const char *name = dalcs_arena_printf(parser->arena, "v(%s)", node_name);
    if (!name) {
        return DALCS_E_NOMEM;
    }
    long column = dalcs_signal_find_column(parser->waveforms, name);
    return column >= 0 ? dalcs_drawn_column(parser, (size_t)column, node)
                       : refuse_name(parser, name);
}

enum dalcs_status dalcs_drawn_name(struct dalcs_drawn_parser *parser, char *name,
                                   const struct dalcs_signal_node **node) {
    long column = dalcs_signal_find_column(parser->waveforms, name);
    if (column < 0) {
        column = find_current(parser->waveforms, name);
    }
    if (column >= 0) {
        return dalcs_drawn_column(parser, (size_t)column, node);
    }
    char *comma = strchr(name, ',');
    size_t length = strlen(name);
    if (!comma || strncasecmp(name, "v(", 2) != 0) {
        return refuse_name(parser, name);
    }
    const struct dalcs_signal_node *plus = NULL, *minus = NULL;
    *comma = '\0';
    name[length - 1] = '\0'; /* the parenthesis */
    DALCS_TRY(take_node(parser, name + 2, &plus));
    DALCS_TRY(take_node(parser, comma + 1, &minus));
    return dalcs_drawn_combine(parser, DALCS_DRAWN_SUBTRACT, plus, minus, node);
}
