/* file_gates.c - gates and flip-flops at an operating point: what their sources put out against what they read.
 *
 * Nothing is on its way there, so that a delay plays no part. What a latch or a flip-flop remembers is known only where its
 * inputs say it; a bit that is not known makes what depends on it not known. */
#include "file_internal.h"

enum bit { LOW, HIGH, NOT_KNOWN };

static enum bit bit_of(bool is_high) {
    return is_high ? HIGH : LOW;
}

static enum bit inverted(enum bit bit, bool is_inverted) {
    return bit == NOT_KNOWN ? bit : bit_of((bit == HIGH) != is_inverted);
}

static enum bit read(const struct file_audit *a, const struct file_row *row,
                     const struct dalcs_logic_input *input) {
    const struct dalcs_circuit *c = a->circuit;
    enum bit bit = LOW; /* open */
    if (input->from == DALCS_GATE_COMPARATOR) {
        const unsigned char position = row->position[c->control.comparator[input->index]];
        bit = position == FILE_CLOSED ? HIGH : position == FILE_OPEN ? LOW : NOT_KNOWN;
    } else if (input->from == DALCS_GATE_GATE) {
        bit = (enum bit)a->gates.bit[input->index];
    }
    return inverted(bit, input->is_inverted);
}

/* How many inputs are high and how many are not known, of those that are wired. */
static enum bit of_inputs(const struct file_audit *a, const struct file_row *row,
                          const struct dalcs_logic_gate *g) {
    int n[3] = {0};
    for (int i = 0; i < g->n_inputs; i++) {
        if (g->input[i].from != DALCS_GATE_OPEN) {
            n[read(a, row, &g->input[i])]++;
        }
    }
    switch (g->kind) {
    case DALCS_GATE_AND:
        return n[LOW] > 0 ? LOW : n[NOT_KNOWN] > 0 ? NOT_KNOWN : HIGH;
    case DALCS_GATE_XOR:
        return n[NOT_KNOWN] > 0 ? NOT_KNOWN : bit_of(n[HIGH] % 2 == 1);
    case DALCS_GATE_ONE:
        return n[HIGH] > 1 ? LOW : n[NOT_KNOWN] > 0 ? NOT_KNOWN : bit_of(n[HIGH] == 1);
    default:
        return n[HIGH] > 0 ? HIGH : n[NOT_KNOWN] > 0 ? NOT_KNOWN : LOW;
    }
}

/* What clears wins over what sets. */
static enum bit forced(enum bit clears, enum bit sets) {
    return clears == HIGH ? LOW : clears == LOW && sets == HIGH ? HIGH : NOT_KNOWN;
}

/* Where nothing is forced, a latch whose clock is high has its data. */
static enum bit of_memory(const struct file_audit *a, const struct file_row *row,
                          const struct dalcs_logic_gate *g) {
    const enum bit clears = read(a, row, &g->input[DALCS_GATE_CLEAR]);
    const enum bit sets = read(a, row, &g->input[DALCS_GATE_PRESET]);
    const bool is_open =
        dalcs_gate_is_transparent(g) && read(a, row, &g->input[DALCS_GATE_CLOCK]) == HIGH;
    if (!is_open || clears != LOW || sets != LOW) {
        return forced(clears, sets);
    }
    const enum bit data = read(a, row, &g->input[DALCS_GATE_DATA]);
    return g->kind == DALCS_GATE_DATA_LATCH
               ? data
               : forced(read(a, row, &g->input[DALCS_GATE_RESET]), data);
}

static enum bit wanted(const struct file_audit *a, const struct file_row *row,
                       const struct dalcs_logic_gate *g) {
    switch (g->kind) {
    case DALCS_GATE_LATCH:
        return forced(read(a, row, &g->input[1]), read(a, row, &g->input[0]));
    case DALCS_GATE_COUNTER:
        return read(a, row, &g->input[1]) == HIGH ? LOW : NOT_KNOWN;
    case DALCS_GATE_MONOSTABLE:
        return read(a, row, &g->input[DALCS_GATE_CLEAR]) == HIGH ? LOW : NOT_KNOWN;
    case DALCS_GATE_SAMPLE:
        return NOT_KNOWN;
    default:
        return dalcs_gate_has_clock(g) ? of_memory(a, row, g) : of_inputs(a, row, g);
    }
}

/* The device that shows q, end 0, or its complement; -1: none does. */
static int source_of(const struct file_audit *a, const struct dalcs_logic_gate *g, int end) {
    return g->output[end] >= 0 ? a->gates.source[g->output[end]] : -1;
}

static void find_sources(struct file_audit *a) {
    const struct dalcs_circuit *c = a->circuit;
    for (int k = 0; k < c->n_stimuli; k++) {
        a->gates.source[k] = -1;
    }
    for (int d = 0; d < c->n_devices; d++) {
        if (c->device[d].kind == DALCS_VSOURCE) {
            a->gates.source[c->device[d].stimulus] = d;
        }
    }
}

/* As its source shows it. */
static enum bit shown(const struct file_row *row, const struct dalcs_logic_gate *g) {
    const int end = g->output[0] >= 0 ? 0 : 1;
    if (g->device < 0 || g->kind == DALCS_GATE_SAMPLE || !row->u[g->device].known) {
        return NOT_KNOWN;
    }
    return inverted(bit_of(row->u[g->device].value > 0.5 * (g->low + g->high)), end == 1);
}

/* Those that nothing shows follow from the others, one behind the other. */
static void find_bits(struct file_audit *a, const struct file_row *row) {
    const struct dalcs_circuit *c = a->circuit;
    bool goes_on = true;
    for (int k = 0; k < c->control.n_gates; k++) {
        a->gates.bit[k] = (unsigned char)shown(row, &c->control.gate[k]);
    }
    while (goes_on) {
        goes_on = false;
        for (int k = 0; k < c->control.n_gates; k++) {
            if (a->gates.bit[k] == NOT_KNOWN) {
                a->gates.bit[k] = (unsigned char)wanted(a, row, &c->control.gate[k]);
                goes_on = goes_on || a->gates.bit[k] != NOT_KNOWN;
            }
        }
    }
}

static void check_output(struct file_audit *a, const struct file_row *row, int device,
                         double level) {
    const struct file_number u = row->u[device];
    if (u.known) {
        file_find(a, DALCS_AUDIT_BRANCH, device, "V", fabs(u.value - level),
                  u.error + file_volts(a, device), row->t, row->t);
    }
}

void file_check_gates(struct file_audit *a, const struct file_row *row) {
    const struct dalcs_circuit *c = a->circuit;
    if (!a->is_at_rest || a->promise.are_gates_restless) {
        return;
    }
    find_sources(a);
    find_bits(a, row);
    for (int k = 0; k < c->control.n_gates; k++) {
        const enum bit q = wanted(a, row, &c->control.gate[k]);
        for (int end = 0; end < 2 && q != NOT_KNOWN; end++) {
            const int device = source_of(a, &c->control.gate[k], end);
            const bool is_high = (q == HIGH) == (end == 0);
            if (device >= 0) {
                check_output(a, row, device,
                             is_high ? c->control.gate[k].high : c->control.gate[k].low);
            }
        }
    }
}
