/* spice_names.c - names that ngspice takes, one for each node and device.
 *
 * A name of letters, digits and single underscores stays what it is. Of others the rest becomes
 * underscores, and two of them with the index behind make it unique. */
#include "spice.h"

#include "union_find.h"

#include <string.h>

/* Names that ngspice reads as something else. */
static bool is_reserved(const char *name) {
    static const char *const word[] = {"all", "alli", "allv", "gnd", "time"};
    bool found = false;
    for (size_t i = 0; i < sizeof word / sizeof word[0] && !found; i++) {
        found = strcmp(name, word[i]) == 0;
    }
    return found;
}

static bool is_plain_character(char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
}

static bool is_plain(const char *name) {
    bool plain = strstr(name, "__") == NULL && !is_reserved(name);
    for (const char *c = name; *c != '\0' && plain; c++) {
        plain = is_plain_character(*c);
    }
    return plain;
}

/* NULL without memory. */
static const char *choose_name(struct dalcs_spice_names *names, const char *prefix,
                               const char *name, int index) {
    char *text = dalcs_arena_printf(&names->arena, "%s%s__%d", prefix, name, index);
    for (char *c = text; c != NULL && *c != '\0'; c++) {
        *c = is_plain_character(*c) ? *c : '_';
    }
    return text;
}

/* The letter that an element's card begins with. */
static char letter_of(const struct dalcs_device *device) {
    static const char letter[] = {
        [DALCS_RESISTOR] = 'r', [DALCS_INDUCTOR] = 'l', [DALCS_CAPACITOR] = 'c',
        [DALCS_VSOURCE] = 'v',  [DALCS_ISOURCE] = 'i',  [DALCS_VCVS] = 'e',
        [DALCS_CCCS] = 'f',     [DALCS_VCCS] = 'g',     [DALCS_CCVS] = 'h',
        [DALCS_DIODE] = 'd',    [DALCS_SWITCH] = 's'};
    return device->behaviour != NULL                              ? 'b'
           : device->kind == DALCS_SWITCH && device->control >= 0 ? 'w'
                                                                  : letter[device->kind];
}

static enum dalcs_status name_nodes(struct dalcs_spice_names *names) {
    const struct dalcs_circuit *circuit = names->circuit;
    for (int i = 1; i < circuit->n_nodes; i++) {
        const char *name = circuit->node_name[i];
        names->node[i] = is_plain(name) ? name : choose_name(names, "", name, i);
        if (names->node[i] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    names->node[0] = "0";
    return DALCS_OK;
}

static enum dalcs_status name_devices(struct dalcs_spice_names *names) {
    const struct dalcs_circuit *circuit = names->circuit;
    for (int i = 0; i < circuit->n_devices; i++) {
        const char *name = circuit->device[i].name;
        const char prefix[] = {letter_of(&circuit->device[i]), '\0'};
        names->device[i] =
            is_plain(name) && name[0] == prefix[0] ? name : choose_name(names, prefix, name, i);
        if (names->device[i] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    return DALCS_OK;
}

/* ngspice gives the currents of V, L, E and H by itself. */
static bool gives_current(const struct dalcs_device *device) {
    return device->kind == DALCS_VSOURCE || device->kind == DALCS_INDUCTOR ||
           device->kind == DALCS_CCVS || (device->kind == DALCS_VCVS && device->behaviour == NULL);
}

static void join_shorts(struct dalcs_spice_names *names) {
    const struct dalcs_circuit *circuit = names->circuit;
    dalcs_union_reset(names->node_of, circuit->n_nodes);
    for (int i = 0; i < circuit->n_devices; i++) {
        const struct dalcs_device *device = &circuit->device[i];
        if (dalcs_device_is_short(device) && !names->is_sensed[i]) {
            dalcs_union_join(names->node_of, device->node[0], device->node[1]);
        }
    }
    for (int i = 0; i < circuit->n_nodes; i++) {
        names->node_of[i] = dalcs_union_find(names->node_of, i);
    }
}

/* Of a voltage: its nodes. */
static enum dalcs_status name_columns(struct dalcs_spice_names *names) {
    for (int i = 0; i < names->circuit->results.n_signals; i++) {
        const struct dalcs_signal *signal = &names->circuit->results.signal[i];
        bool is_voltage = signal->kind == DALCS_SIGNAL_VOLTAGE;
        for (int k = 0; k < (is_voltage ? 2 : 1); k++) {
            int node = is_voltage ? names->node_of[signal->node[k]] : 0, d = signal->device;
            if (is_voltage && node == 0) {
                continue;
            }
            char *name = is_voltage ? dalcs_arena_printf(&names->arena, "v(%s)", names->node[node])
                         : names->is_sensed[d]
                             ? dalcs_arena_printf(&names->arena, "i(v__%d)", d)
                             : dalcs_arena_printf(&names->arena, "i(%s)", names->device[d]);
            if (name == NULL) {
                return DALCS_E_NOMEM;
            }
            names->column[i][k] = name;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status choose_all(struct dalcs_spice_names *names) {
    const struct dalcs_circuit *circuit = names->circuit;
    size_t n_nodes = (size_t)circuit->n_nodes, n_devices = (size_t)circuit->n_devices;
    names->node_of = dalcs_arena_alloc(&names->arena, n_nodes, sizeof(*names->node_of));
    names->node = dalcs_arena_alloc(&names->arena, n_nodes, sizeof(*names->node));
    names->device = dalcs_arena_alloc(&names->arena, n_devices, sizeof(*names->device));
    names->is_sensed = dalcs_arena_alloc(&names->arena, n_devices, sizeof(*names->is_sensed));
    names->column = dalcs_arena_alloc(&names->arena, (size_t)circuit->results.n_signals,
                                      sizeof(*names->column));
    if (names->node_of == NULL || names->node == NULL || names->device == NULL ||
        names->is_sensed == NULL || names->column == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(name_nodes(names));
    DALCS_TRY(name_devices(names));
    dalcs_circuit_mark_wanted_currents(circuit, names->is_sensed);
    for (int i = 0; i < circuit->n_devices; i++) {
        names->is_sensed[i] = names->is_sensed[i] && !gives_current(&circuit->device[i]);
    }
    join_shorts(names);
    return name_columns(names);
}

enum dalcs_status dalcs_spice_names_build(struct dalcs_spice_names *names,
                                          const struct dalcs_circuit *circuit) {
    *names = (struct dalcs_spice_names){.circuit = circuit};
    enum dalcs_status status = choose_all(names);
    if (status != DALCS_OK) {
        dalcs_spice_names_finish(names);
    }
    return status;
}

void dalcs_spice_names_finish(struct dalcs_spice_names *names) {
    dalcs_arena_finish(&names->arena);
    *names = (struct dalcs_spice_names){0};
}
