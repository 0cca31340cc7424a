/* coupling.c - K: mutual inductance k sqrt(L1 L2) of two coils.
 *
 * Coils coupled among each other must have an inductance matrix that stores no negative energy; the
 * matrix of the factors k, with 1 on its diagonal, is checked for that. */
#include "builder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] = "a coupling is: Kname Lfirst Lsecond k, with k from -1 to 1";

/* Groups of more coils than this are not checked: the check is cubic. */
enum { MOST_COILS = 200 };

static int find_coil(struct dalcs_builder *builder, const struct dalcs_token *name) {
    const int device = dalcs_builder_find_device(builder, name);
    if (device < 0) {
        return -1;
    }
    /* An inductance of 0 became a resistor: coupling nothing. */
    if (builder->circuit->device[device].kind != DALCS_INDUCTOR) {
        dalcs_builder_error(
            builder, name, USAGE, "'%s' is %s, only inductors can be coupled", name->text,
            name->text[0] == 'l' ? "an inductor of 0 H"
                                 : dalcs_builder_kind_text(builder->circuit->device[device].kind));
        return -1;
    }
    return device;
}

/* A second K of the same two coils is an error. */
static bool is_new_pair(struct dalcs_builder *builder, const struct dalcs_token *card_name,
                        const int *inductor, int place) {
    const int low = inductor[0] < inductor[1] ? inductor[0] : inductor[1];
    const int high = inductor[0] < inductor[1] ? inductor[1] : inductor[0];
    const char *pair = dalcs_builder_hint(builder, "%d %d", low, high);
    if (pair == NULL) {
        return false;
    }
    const int first = dalcs_names_find(&builder->pairs, pair);
    if (first >= 0) {
        dalcs_builder_error(
            builder, card_name, NULL, "'%s' and '%s' are coupled twice, first at %s",
            builder->circuit->device[inductor[0]].name, builder->circuit->device[inductor[1]].name,
            dalcs_builder_place(builder, builder->device_token[first]));
        return false;
    }
    if (dalcs_names_add(&builder->pairs, pair, place) != DALCS_OK) {
        builder->out_of_memory = true;
        return false;
    }
    return true;
}

/* Reads the coils and k; true when the coupling is complete and right. */
static bool read_coupling(struct dalcs_reader *reader, int place, struct dalcs_coupling *coupling) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *coil[2];
    for (int k = 0; k < 2; k++) {
        if (!dalcs_reader_name(reader, "the name of an inductor", &coil[k])) {
            return false;
        }
    }
    const struct dalcs_token *third = dalcs_reader_peek(reader, 0);
    if (third != NULL && third->kind == DALCS_TOKEN_WORD && third->text[0] == 'l') {
        dalcs_builder_error(builder, third, "write one K for each pair of coils",
                            "coupling more than two coils at once is not supported yet");
        return false;
    }
    for (int k = 0; k < 2; k++) {
        coupling->inductor[k] = find_coil(builder, coil[k]);
    }
    if (!dalcs_reader_number(reader, DALCS_PLAIN, "a coupling factor", &coupling->k)) {
        return false;
    }
    if (fabs(coupling->k) > 1) {
        dalcs_builder_error(builder, dalcs_reader_previous(reader), USAGE,
                            "a coupling factor of %g: its magnitude is at most 1", coupling->k);
        return false;
    }
    if (!dalcs_reader_end(reader) || coupling->inductor[0] < 0 || coupling->inductor[1] < 0) {
        return false;
    }
    if (coupling->inductor[0] == coupling->inductor[1]) {
        dalcs_builder_error(builder, coil[1], NULL, "'%s' is coupled to itself", coil[1]->text);
        return false;
    }
    return is_new_pair(builder, reader->card->token, coupling->inductor, place);
}

void dalcs_coupling_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_coupling *coupling = &circuit->coupling[circuit->n_couplings];
    const int place = builder->n_device_cards + builder->n_couplings_seen++;
    builder->device_token[place] = card->token;
    dalcs_builder_add_name(builder, card->token, place);
    coupling->name =
        dalcs_arena_copy(&circuit->arena, card->token->text, strlen(card->token->text));
    coupling->where = dalcs_builder_keep_location(builder, card->token);
    if (coupling->name == NULL) {
        builder->out_of_memory = true;
        return;
    }
    if (read_coupling(&reader, place, coupling)) {
        circuit->n_couplings++;
    }
}

/* ---- Can these coils exist? ---------------------------------------------------------------- */

/* Coupled coils in groups, each joined to the others of its group by some chain of couplings. */
struct groups {
    int *parent;   /* [n_devices] another coil of the group, itself for the group's first */
    int *position; /* [n_devices] place in its group's matrix, -1: not placed yet */
    int *size;     /* [n_devices] of the group, at its first coil */
    int *head;     /* [n_devices] the group's last coupling, at its first coil, -1 for none */
    int *next;     /* [n_couplings] another coupling of the group, -1 at the end */
};

static int first_of(const struct groups *groups, int coil) {
    while (groups->parent[coil] != coil) {
        groups->parent[coil] = groups->parent[groups->parent[coil]];
        coil = groups->parent[coil];
    }
    return coil;
}

static void place(struct groups *groups, int coil) {
    if (groups->position[coil] < 0) {
        groups->position[coil] = groups->size[first_of(groups, coil)]++;
    }
}

/* Is the symmetric matrix A (n by n, 1 on its diagonal) free of negative eigenvalues? Cholesky with
 * the largest pivot first; A is overwritten. Coils coupled with k = 1 make it singular, so rounding
 * of n numbers of size 1 must pass. */
static bool is_semidefinite(double *A, int n) {
    const double rounding = 1e-9;
    for (int step = 0; step < n; step++) {
        int pivot = step;
        for (int k = step; k < n; k++) {
            if (A[k * n + k] < -rounding) {
                return false;
            }
            pivot = A[k * n + k] > A[pivot * n + pivot] ? k : pivot;
        }
        for (int k = 0; k < n; k++) { /* swap rows, then columns */
            const double t = A[step * n + k];
            A[step * n + k] = A[pivot * n + k];
            A[pivot * n + k] = t;
        }
        for (int k = 0; k < n; k++) {
            const double t = A[k * n + step];
            A[k * n + step] = A[k * n + pivot];
            A[k * n + pivot] = t;
        }
        const double d = A[step * n + step];
        for (int i = step + 1; i < n; i++) {
            /* No diagonal left: what remains beside it must vanish too. */
            if (d <= rounding && fabs(A[i * n + step]) > sqrt(rounding)) {
                return false;
            }
            for (int j = step + 1; j < n && d > rounding; j++) {
                A[i * n + j] -= A[i * n + step] * A[step * n + j] / d;
            }
        }
    }
    return true;
}

/* The group whose first coil is `root`. */
static enum dalcs_status check_group(struct dalcs_builder *builder, const struct groups *groups,
                                     int root) {
    const struct dalcs_circuit *circuit = builder->circuit;
    const int n = groups->size[root];
    if (n < 3 || n > MOST_COILS) {
        return DALCS_OK;
    }
    double *A = dalcs_alloc((size_t)n * (size_t)n, sizeof *A);
    if (A == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < n; k++) {
        A[k * n + k] = 1;
    }
    for (int k = groups->head[root]; k >= 0; k = groups->next[k]) {
        const int i = groups->position[circuit->coupling[k].inductor[0]];
        const int j = groups->position[circuit->coupling[k].inductor[1]];
        A[i * n + j] = A[j * n + i] = circuit->coupling[k].k;
    }
    if (!is_semidefinite(A, n)) {
        dalcs_builder_warn(builder, builder->device_token[root],
                           "of three coils, k12 = k13 = 1 leaves only k23 = 1",
                           "the %d coils coupled with '%s' cannot exist: their inductance matrix "
                           "has a negative eigenvalue, and they can give more energy than they got",
                           n, circuit->device[root].name);
    }
    free(A);
    return DALCS_OK;
}

static enum dalcs_status check_groups(struct dalcs_builder *builder, struct groups *groups) {
    const struct dalcs_circuit *circuit = builder->circuit;
    for (int k = 0; k < circuit->n_devices; k++) {
        groups->parent[k] = k;
        groups->position[k] = -1;
        groups->head[k] = -1;
    }
    for (int k = 0; k < circuit->n_couplings; k++) {
        const int *coil = circuit->coupling[k].inductor;
        groups->parent[first_of(groups, coil[1])] = first_of(groups, coil[0]);
    }
    for (int k = 0; k < circuit->n_couplings; k++) {
        const int root = first_of(groups, circuit->coupling[k].inductor[0]);
        place(groups, circuit->coupling[k].inductor[0]);
        place(groups, circuit->coupling[k].inductor[1]);
        groups->next[k] = groups->head[root];
        groups->head[root] = k;
    }
    for (int k = 0; k < circuit->n_devices; k++) {
        if (groups->size[k] > 0) {
            DALCS_TRY(check_group(builder, groups, k));
        }
    }
    return DALCS_OK;
}

void dalcs_coupling_check(struct dalcs_builder *builder) {
    const int n_devices = builder->circuit->n_devices;
    const int n_couplings = builder->circuit->n_couplings;
    if (n_couplings < 2) {
        return;
    }
    int *memory = dalcs_alloc(4 * (size_t)n_devices + (size_t)n_couplings, sizeof *memory);
    if (memory == NULL) {
        builder->out_of_memory = true;
        return;
    }
    struct groups groups = {.parent = memory,
                            .position = memory + n_devices,
                            .size = memory + 2 * (size_t)n_devices,
                            .head = memory + 3 * (size_t)n_devices,
                            .next = memory + 4 * (size_t)n_devices};
    if (check_groups(builder, &groups) != DALCS_OK) {
        builder->out_of_memory = true;
    }
    free(memory);
}
