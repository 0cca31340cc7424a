/* plot_command.c - the plots that runs have made: setplot, destroy, display, setscale, settype. */
#include "lower_case.h"
#include "script_internal.h"

#include <string.h>

/* A plot by its name; NULL: there is none, which was said. */
static const struct dalcs_plot_vectors *
find_plot(struct dalcs_script *script, const struct dalcs_statement *s, const char *name) {
    const struct dalcs_vectors *all = &script->vectors;
    const struct dalcs_plot_vectors *plot = dalcs_plots_find(all, name);
    const struct dalcs_plot_vectors *newest = all->n > 0 ? all->plot[all->n - 1] : NULL;
    if (plot == NULL) {
        (void)dalcs_script_refuse(
            script, s,
            newest != NULL
                ? dalcs_arena_printf(&script->arena, "the newest one is '%s'", newest->type)
                : "no analysis has been run yet",
            "there is no plot '%s'", name);
    }
    return plot;
}

/* The plot made before or after the current one. */
static const struct dalcs_plot_vectors *beside(const struct dalcs_vectors *all, bool is_next) {
    size_t k = 0; /* 1 more than its index; 0: const */
    while (all->current != NULL && (k == 0 || all->plot[k - 1] != all->current)) {
        k++;
    }
    k = is_next ? k + 1 : k - (k > 0);
    return k == 0 ? &all->own : all->plot[(k <= all->n ? k : all->n) - 1];
}

enum dalcs_status dalcs_script_choose_plot(struct dalcs_script *script,
                                           const struct dalcs_statement *s, const char *name) {
    struct dalcs_vectors *all = &script->vectors;
    char *low = dalcs_arena_copy(&script->arena, name, strlen(name));
    if (low == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_lower_text(low);
    if (strcmp(low, "new") == 0) {
        return dalcs_plots_make(all, "unknown", "unknown", "Anonymous");
    }
    const bool is_next = strcmp(low, "next") == 0;
    const struct dalcs_plot_vectors *plot =
        is_next || strcmp(low, "previous") == 0 ? beside(all, is_next) : find_plot(script, s, low);
    if (plot == NULL) {
        return DALCS_E_NETLIST;
    }
    dalcs_plots_choose(all, plot);
    return DALCS_OK;
}

static void list_plot(FILE *out, const struct dalcs_vectors *all,
                      const struct dalcs_plot_vectors *plot) {
    fputs(plot == dalcs_plots_current(all) ? "Current " : "\t", out);
    if (plot == &all->own) {
        fputs("const\tConstant values (constants)\n", out);
    } else {
        fprintf(out, "%s\t%s (%s)\n", plot->type, plot->title, plot->kind);
    }
}

/* setplot alone lists them, the newest first. */
enum dalcs_status dalcs_script_setplot(struct dalcs_script *script,
                                       const struct dalcs_statement *s) {
    const struct dalcs_vectors *all = &script->vectors;
    FILE *out = script->host->out;
    const char *text;
    DALCS_TRY(dalcs_script_expand(script, s, &text));
    const char *name = dalcs_script_word(script, &text);
    if (name != NULL) {
        return dalcs_script_choose_plot(script, s, name);
    }
    fputs("List of plots available:\n\n", out);
    for (size_t k = all->n; k > 0; k--) {
        list_plot(out, all, all->plot[k - 1]);
    }
    list_plot(out, all, &all->own);
    return DALCS_OK;
}

enum dalcs_status dalcs_script_destroy(struct dalcs_script *script,
                                       const struct dalcs_statement *s) {
    struct dalcs_vectors *all = &script->vectors;
    const char *text;
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    const char *name = dalcs_script_word(script, &text);
    if (name == NULL) {
        dalcs_plots_destroy(all, all->current);
    }
    for (; name != NULL; name = dalcs_script_word(script, &text)) {
        if (strcmp(name, "all") == 0) {
            dalcs_plots_destroy_all(all);
            continue;
        }
        const struct dalcs_plot_vectors *plot = find_plot(script, s, name);
        if (plot == NULL) {
            return DALCS_E_NETLIST;
        }
        dalcs_plots_destroy(all, plot);
    }
    return DALCS_OK;
}

static const char *const TYPE[] = {
    [DALCS_VOLT] = "voltage",        [DALCS_AMPERE] = "current",
    [DALCS_UNIT_SECOND] = "time",    [DALCS_UNIT_HERTZ] = "frequency",
    [DALCS_UNIT_OHM] = "resistance", [DALCS_UNIT_NONE] = "notype"};

enum dalcs_status dalcs_script_display(struct dalcs_script *script,
                                       const struct dalcs_statement *s) {
    const struct dalcs_vectors *all = &script->vectors;
    const struct dalcs_plot_vectors *plot = dalcs_plots_current(all);
    FILE *out = script->host->out;
    (void)s;
    fputs("Here are the vectors currently active:\n\n", out);
    if (plot == &all->own) {
        fputs("Title: Constant values\nName: const (constants)\n\n", out);
    } else {
        fprintf(out, "Title: %s\nName: %s (%s)\n\n", plot->title, plot->type, plot->kind);
    }
    for (size_t k = 0; k < plot->n; k++) {
        const struct dalcs_vector *v = plot->vector[k];
        fprintf(out, "    %-20s: %s, %s, %zu long%s\n", v->name, TYPE[v->unit],
                v->is_complex ? "complex" : "real", v->n,
                v == plot->scale ? " [default scale]" : "");
    }
    fputc('\n', out);
    return DALCS_OK;
}

/* The vector of the current plot with this name; NULL: there is none, which was said. */
static struct dalcs_vector *find_vector(struct dalcs_script *script,
                                        const struct dalcs_statement *s, const char *name) {
    struct dalcs_plot_vectors *plot =
        script->vectors.current != NULL ? script->vectors.current : &script->vectors.own;
    const struct dalcs_vector *found = dalcs_vectors_find(&script->vectors, name);
    for (size_t k = 0; k < plot->n; k++) {
        if (plot->vector[k] == found) {
            return plot->vector[k];
        }
    }
    (void)dalcs_script_refuse(script, s, "setplot chooses another plot",
                              "the current plot has no vector '%s'", name);
    return NULL;
}

/* setscale vector: what the others are shown over. Alone it says which that is. */
enum dalcs_status dalcs_script_setscale(struct dalcs_script *script,
                                        const struct dalcs_statement *s) {
    const char *text;
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    const char *name = dalcs_script_word(script, &text);
    const struct dalcs_vector *scale = dalcs_plots_current(&script->vectors)->scale;
    if (name == NULL) {
        fprintf(script->host->out, "%s\n", scale != NULL ? scale->name : "no scale");
        return DALCS_OK;
    }
    struct dalcs_vector *found = find_vector(script, s, name);
    if (found == NULL) {
        return DALCS_E_NETLIST;
    }
    (script->vectors.current != NULL ? script->vectors.current : &script->vectors.own)->scale =
        found;
    return DALCS_OK;
}

/* settype voltage x y: what the axes of plots are called. A type without a unit here changes nothing. */
enum dalcs_status dalcs_script_settype(struct dalcs_script *script,
                                       const struct dalcs_statement *s) {
    const char *text;
    DALCS_TRY(dalcs_script_expand_low(script, s, &text));
    const char *type = dalcs_script_word(script, &text);
    if (type == NULL) {
        return dalcs_script_refuse(script, s, "settype voltage x",
                                   "a type and vectors are missing");
    }
    enum dalcs_unit unit = DALCS_UNIT_NONE;
    for (size_t k = 0; k < sizeof TYPE / sizeof TYPE[0]; k++) {
        unit = TYPE[k] != NULL && strcmp(TYPE[k], type) == 0 ? (enum dalcs_unit)k : unit;
    }
    for (const char *name; (name = dalcs_script_word(script, &text)) != NULL;) {
        struct dalcs_vector *v = find_vector(script, s, name);
        if (v == NULL) {
            return DALCS_E_NETLIST;
        }
        v->unit = unit;
    }
    return DALCS_OK;
}
