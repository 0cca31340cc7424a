/* values.c - the names that a netlist gives to values, and other values for them. */
#include "lower_case.h"
#include "pi.h"
#include "session_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_word(const struct dalcs_card *card, const char *word) {
    return strcmp(card->token->text, word) == 0;
}

static bool declares_parameters(const struct dalcs_card *card) {
    return is_word(card, ".param") || is_word(card, ".params") || is_word(card, ".csparam") ||
           is_word(card, ".global_param");
}

/* Of subcircuits: what is inside has other names outside. */
static int change_of_depth(const struct dalcs_card *card) {
    return is_word(card, ".subckt") ? 1 : is_word(card, ".ends") ? -1 : 0;
}

const char *dalcs_session_parameter_name(const struct dalcs_session *session, size_t index) {
    const size_t n_cards = session->source.has_netlist ? session->source.netlist.n_cards : 0;
    int depth = 0;
    for (size_t k = 0; k < n_cards; k++) {
        const struct dalcs_card *card = &session->source.netlist.card[k];
        depth += change_of_depth(card);
        for (int i = 1; depth == 0 && declares_parameters(card) && i + 1 < card->n; i++) {
            if (card->token[i + 1].kind == DALCS_TOKEN_EQUAL && index-- == 0) {
                return card->token[i].text;
            }
        }
    }
    return NULL;
}

const char *dalcs_session_element_name(const struct dalcs_session *session, size_t index) {
    const bool has = session->has_circuit && index < (size_t)session->circuit.n_devices;
    return has ? session->circuit.device[index].name : NULL;
}

/* "dmod(vfwd)" is cut in two; the field is NULL where the name has none. */
static char *cut_field(char *name) {
    char *open = strchr(name, '('), *close = strchr(name, ')');
    if (open == NULL || close == NULL || close < open || close[1] != '\0') {
        return NULL;
    }
    *open = *close = '\0';
    return open + 1;
}

/* What a subcircuit calls so is another value in each of its instances, and nothing outside. */
static bool is_parameter(const struct dalcs_session *s, const char *name) {
    bool is = false;
    const char *known;
    for (size_t k = 0; !is && (known = dalcs_session_parameter_name(s, k)) != NULL; k++) {
        is = strcmp(known, name) == 0;
    }
    return is;
}

/* A device, or a card outside of subcircuits that has a value but is no device, as K; also while the circuit
 * could not be built. */
static bool is_element(const struct dalcs_session *s, const char *name) {
    bool is = false;
    const char *known;
    for (size_t k = 0; !is && (known = dalcs_session_element_name(s, k)) != NULL; k++) {
        is = strcmp(known, name) == 0;
    }
    int depth = 0;
    for (size_t k = 0; !is && k < s->source.netlist.n_cards; k++) {
        const struct dalcs_card *card = &s->source.netlist.card[k];
        depth += change_of_depth(card);
        is = depth == 0 && name[0] != '.' && name[0] != 'x' && is_word(card, name);
    }
    return is;
}

typedef const char *(*name_at)(const struct dalcs_session *session, size_t index);

static const char *nearest_name(const struct dalcs_session *s, name_at name_of, const char *name) {
    const char *nearest = NULL, *known;
    for (size_t k = 0; nearest == NULL && (known = name_of(s, k)) != NULL; k++) {
        nearest = dalcs_names_nearest_of(&known, 1, name);
    }
    return nearest;
}

static void tell_unknown(struct dalcs_session *s, const char *name, const char *nearest) {
    char *hint =
        nearest != NULL ? dalcs_arena_printf(&s->arena, "did you mean '%s'?", nearest) : NULL;
    dalcs_diag_add(&s->diag, DALCS_ERROR, NULL, hint,
                   "the netlist has no parameter or element '%s'", name);
}

enum dalcs_status dalcs_session_set_value(struct dalcs_session *session, const char *name,
                                          double value) {
    if (!session->source.has_netlist) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, DALCS_KEEP_HINT,
                       "'%s' cannot be set: no netlist was read that keeps its cards", name);
        return DALCS_E_OPTION;
    }
    if (!isfinite(value)) {
        dalcs_diag_add(&session->diag, DALCS_ERROR, NULL, NULL, "'%s' cannot be %g", name, value);
        return DALCS_E_OPTION;
    }
    char *low = dalcs_arena_copy(&session->arena, name, strlen(name));
    if (low == NULL) {
        return DALCS_E_NOMEM;
    }
    const char *field = cut_field(dalcs_lower_text(low)), *nearest = NULL;
    const bool is_set = field == NULL && is_parameter(session, low);
    enum dalcs_status status = DALCS_E_OPTION;
    if (field != NULL || is_set || is_element(session, low)) {
        status = dalcs_session_alter(session, is_set, low, field, value, &nearest);
    } else {
        nearest = nearest_name(session, dalcs_session_parameter_name, low);
        nearest =
            nearest != NULL ? nearest : nearest_name(session, dalcs_session_element_name, low);
    }
    if (status == DALCS_E_OPTION) {
        tell_unknown(session, name, nearest);
    }
    return status;
}

enum dalcs_status dalcs_session_apply_values(struct dalcs_session *session) {
    if (session->source.is_altered) {
        session->source.is_altered = false;
        session->source.steps.is_known = false;
        DALCS_TRY(dalcs_session_rebuild(session, NULL, 0));
    }
    return session->has_network ? DALCS_OK : DALCS_E_NETLIST;
}

/* ---- What they are -------------------------------------------------------------------------------- */

/* Is it the name of the value that an element of this kind has? */
static bool is_its_value(enum dalcs_device_kind kind, const char *field) {
    static const struct {
        enum dalcs_device_kind kind;
        const char *name[2];
    } known[] = {{DALCS_RESISTOR, {"resistance", "r"}}, {DALCS_CAPACITOR, {"capacitance", "c"}},
                 {DALCS_INDUCTOR, {"inductance", "l"}}, {DALCS_VCVS, {"gain", "gain"}},
                 {DALCS_VCCS, {"gain", "gain"}},        {DALCS_CCVS, {"gain", "gain"}},
                 {DALCS_CCCS, {"gain", "gain"}}};

    bool is = false;
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) {
        is = is || (known[k].kind == kind &&
                    (strcmp(known[k].name[0], field) == 0 || strcmp(known[k].name[1], field) == 0));
    }
    return is;
}

/* Of a V or I. */
static bool source_value(const struct dalcs_stimulus *s, const char *field, double *value) {
    const bool is_size = strcmp(field, "acmag") == 0, is_phase = strcmp(field, "acphase") == 0;
    *value = is_size    ? hypot(s->ac_real, s->ac_imaginary)
             : is_phase ? atan2(s->ac_imaginary, s->ac_real) * (180.0 / dalcs_pi)
                        : s->dc;
    return is_size || is_phase || strcmp(field, "dc") == 0;
}

enum dalcs_status dalcs_session_element_value(struct dalcs_session *session, const char *name,
                                              const char *field, double *value) {
    const enum dalcs_status status =
        session->source.has_netlist ? dalcs_session_apply_values(session) : DALCS_E_OPTION;
    if (status != DALCS_OK) {
        return status == DALCS_E_NOMEM ? status : DALCS_E_OPTION;
    }
    const struct dalcs_circuit *c = &session->circuit;
    for (int d = 0; d < c->n_devices; d++) {
        const struct dalcs_device *device = &c->device[d];
        if (strcmp(device->name, name) != 0) {
            continue;
        }
        if (device->kind == DALCS_VSOURCE || device->kind == DALCS_ISOURCE) {
            return source_value(&c->stimulus[device->stimulus], field, value) ? DALCS_OK
                                                                              : DALCS_E_OPTION;
        }
        *value = device->value;
        const bool is = device->behaviour == NULL && is_its_value(device->kind, field);
        return is ? DALCS_OK : DALCS_E_OPTION;
    }
    return DALCS_E_OPTION;
}
