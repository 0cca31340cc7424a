/* tolerance_models.c - models with tolerances: which they are, and their values for a device. */
#include "tolerance.h"

#include "number.h"

#include <string.h>

char dalcs_tolerance_passive_type(const struct dalcs_card *card) {
    static const struct {
        const char *name;
        char letter;
    } types[] = {{"r", 'r'}, {"res", 'r'}, {"c", 'c'}, {"cap", 'c'}, {"l", 'l'}, {"ind", 'l'}};

    for (size_t k = 0; k < sizeof types / sizeof types[0] && card->n > 2; k++) {
        if (strcmp(card->token[2].text, types[k].name) == 0) {
            return types[k].letter;
        }
    }
    return '\0';
}

double dalcs_tolerance_size(const struct dalcs_tolerance *t, double nominal) {
    return t->is_relative ? t->size * nominal : t->size;
}

/* Those that follow no parameter's value are of none. An R, L or C takes its factor alone from a model. */
static bool check_model(struct dalcs_tolerant *all, struct dalcs_tolerant_model *m,
                        const struct dalcs_card *card) {
    const char letter = dalcs_tolerance_passive_type(card);
    const char own[] = {letter, '\0'};
    int n = 0;
    for (int k = 0; k < m->n; k++) {
        const struct dalcs_tolerances *t = &m->value[k];
        const struct dalcs_token *token = t->dev.token != NULL ? t->dev.token : t->lot.token;
        all->first = all->first != NULL ? all->first : token;
        if (t->name == NULL && letter == '\0') {
            dalcs_language_report(all->language, DALCS_ERROR, NULL, token,
                                  "write it behind the value: D(vfwd=0.7 DEV=5%)",
                                  "this tolerance follows no parameter");
            return false;
        }
        if (letter == '\0' || t->name == NULL || strcmp(t->name, own) == 0) {
            m->value[n] = *t;
            m->value[n].dev.is_relative |= letter != '\0'; /* of a factor that is 1 */
            m->value[n].lot.is_relative |= letter != '\0';
            n++;
        }
    }
    m->n = n;
    return true;
}

bool dalcs_tolerance_take_model(struct dalcs_tolerant *all, size_t k) {
    struct dalcs_language *language = all->language;
    struct dalcs_card *card = &language->deck->own[k];
    struct dalcs_tolerant_model m = {.card = k};
    if (!dalcs_tolerances_take(language, card, &m.value, &m.n)) {
        return false;
    }
    if (m.n == 0 || !check_model(all, &m, card)) {
        return m.n == 0;
    }
    const char *name = card->token[1].text;
    m.lot = dalcs_tolerance_lot_of_model(language, name);
    if (m.lot == NULL ||
        dalcs_grow(&all->model, &all->capacity, all->n_models + 1, sizeof *all->model) !=
            DALCS_OK ||
        dalcs_names_set(&all->models, name, (int)all->n_models) != DALCS_OK) {
        language->out_of_memory = true;
        return false;
    }
    all->model[all->n_models++] = m;
    return true;
}

bool dalcs_tolerance_nominal(struct dalcs_language *language, const struct dalcs_card *card, int at,
                             const struct dalcs_token *tolerance, double *value) {
    const struct dalcs_token *token = at < card->n ? &card->token[at] : NULL;
    struct dalcs_number number;
    if (token != NULL && token->kind == DALCS_TOKEN_NUMBER) {
        *value = token->value;
        return true;
    }
    if (token != NULL && token->kind == DALCS_TOKEN_WORD &&
        dalcs_number_parse_as(token->text, language->netlist->dialect.name, &number) ==
            DALCS_NUMBER_OK) {
        *value = number.value;
        return true;
    }
    if (token == NULL || token->kind != DALCS_TOKEN_BAD) {
        dalcs_language_report(language, DALCS_ERROR, NULL, tolerance,
                              "for a value inside of a formula or a waveform write mc, unif or "
                              "agauss, such as SIN(0 {mc(10, 0.05)} 50)",
                              "this tolerance is of a value that is no number");
    }
    return false;
}

enum dalcs_status dalcs_tolerance_set_model(struct dalcs_tolerant *all,
                                            const struct dalcs_tolerant_model *m,
                                            const char *device, struct dalcs_card *card) {
    struct dalcs_language *language = all->language;
    for (int k = 0; k < m->n; k++) {
        const struct dalcs_tolerances *t = &m->value[k];
        const struct dalcs_token *token = t->dev.token != NULL ? t->dev.token : t->lot.token;
        double nominal;
        if (!dalcs_tolerance_nominal(language, card, t->at, token, &nominal)) {
            return DALCS_OK;
        }
        const bool has_dev = t->dev.token != NULL;
        const char *model = language->deck->own[m->card].token[1].text;
        const char *name =
            dalcs_language_text(language, "%s(%s)", device != NULL ? device : model, t->name);
        if (name == NULL) {
            return DALCS_E_NOMEM;
        }
        double value = nominal;
        if (device != NULL && has_dev) {
            value += dalcs_tolerance_size(&t->dev, nominal) *
                     dalcs_tolerance_draw_dev(all, &t->dev, device, t->name, name);
        }
        if (t->lot.token != NULL) {
            value += dalcs_tolerance_size(&t->lot, nominal) *
                     dalcs_tolerance_draw_lot(all, &t->lot, m->lot, t->name);
        }
        if (value != nominal) {
            DALCS_TRY(dalcs_card_set(language, card, t->at, value));
        }
        if ((device != NULL) == has_dev) {
            dalcs_tolerance_keep(all, name, value);
        }
    }
    return DALCS_OK;
}

bool dalcs_tolerance_model_has_dev(const struct dalcs_tolerant_model *m) {
    bool has = false;
    for (int k = 0; k < m->n; k++) {
        has = has || m->value[k].dev.token != NULL;
    }
    return has;
}
