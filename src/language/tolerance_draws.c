/* tolerance_draws.c - which draws DEV and LOT are: by the name of the device, or of what shares them. */
#include "tolerance.h"

#include <string.h>

/* In units of the tolerance; one run alone has none. */
static double deviation(const struct dalcs_tolerant *all, const struct dalcs_tolerance *t,
                        uint64_t key) {
    const double u =
        all->language->drawing.has_runs ? dalcs_drawn_place(all->language, key, 0) : 0.5;
    return t->is_gauss && u > 0 && u < 1 ? dalcs_normal_quantile(u) : 2 * u - 1;
}

/* The place of a value among those that random functions have a part in, or n_functions. */
static size_t find_function(const struct dalcs_tolerant *all, const char *name) {
    size_t k = 0;
    while (k < all->n_functions && strcmp(all->language->deck->drawn[k].name, name) != 0) {
        k++;
    }
    return k;
}

void dalcs_tolerance_keep(struct dalcs_tolerant *all, const char *name, double value) {
    const size_t k = find_function(all, name);
    if (k < all->n_functions) {
        all->language->deck->drawn[k].value = value;
    } else {
        dalcs_drawn_keep(all->language, name, value);
    }
}

/* Several values may share it. */
static bool is_new(struct dalcs_tolerant *all, const char *name) {
    struct dalcs_language *language = all->language;
    if (!language->drawing.is_worst_case || dalcs_names_find(&all->listed, name) >= 0) {
        return false;
    }
    language->out_of_memory =
        dalcs_names_add(&all->listed, name, 0) != DALCS_OK || language->out_of_memory;
    return true;
}

double dalcs_tolerance_draw_dev(struct dalcs_tolerant *all, const struct dalcs_tolerance *t,
                                const char *device, const char *field, const char *name) {
    const char generator[] = {'.', 'd', 'e', 'v', '/', t->generator, '\0'};
    uint64_t key = dalcs_draw_hash(dalcs_draw_hash_start, device);
    const bool is_shared = t->generator != '\0'; /* by the device's own parameters */
    key = dalcs_draw_hash(key, generator);
    key = is_shared ? key : dalcs_draw_hash(key, field);
    name =
        is_shared ? dalcs_language_text(all->language, "%s(dev/%c)", device, t->generator) : name;
    if (name != NULL && find_function(all, name) < all->n_functions) {
        name = dalcs_language_text(all->language, "%s(dev)", name);
    }
    if (name != NULL && is_new(all, name)) {
        dalcs_drawn_list(all->language, key, name, false);
    }
    return deviation(all, t, key);
}

double dalcs_tolerance_draw_lot(struct dalcs_tolerant *all, const struct dalcs_tolerance *t,
                                const char *lot, const char *field) {
    struct dalcs_language *language = all->language;
    const char *name = t->generator != '\0' ? dalcs_language_text(language, "lot(%c)", t->generator)
                       : field != NULL ? dalcs_language_text(language, "lot(%s.%s)", lot, field)
                                       : dalcs_language_text(language, "lot(%s)", lot);
    if (name == NULL) {
        return 0;
    }
    const uint64_t key = dalcs_draw_hash(dalcs_draw_hash(dalcs_draw_hash_start, ".lot"), name);
    if (is_new(all, name)) {
        dalcs_drawn_list(language, key, name, true);
    }
    return deviation(all, t, key);
}

const char *dalcs_tolerance_lot_of_model(struct dalcs_language *language, const char *flat) {
    const char *dot = strrchr(flat, '.');
    const char *instance =
        dot != NULL ? dalcs_language_text(language, "%.*s", (int)(dot - flat), flat) : NULL;
    const int k = instance != NULL ? dalcs_names_find(&language->deck->instances, instance) : -1;
    return k < 0
               ? flat
               : dalcs_language_text(language, "%s/%s",
                                     language->instances.scope[k]->definition->name->text, dot + 1);
}
