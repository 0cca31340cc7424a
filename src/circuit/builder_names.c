/* builder_names.c - nodes and devices of a circuit by their names, and how to add them. */
#include "builder.h"

#include "lower_case.h"

#include <string.h>

static bool is_ground(const char *name) {
    return strcmp(name, "0") == 0 || strcmp(name, "gnd") == 0;
}

/* -1 when out of memory, which a name that is NULL is, too. */
static int add_node(struct dalcs_builder *builder, const char *name,
                    const struct dalcs_token *token) {
    const int node = builder->circuit->n_nodes;
    const size_t need = (size_t)node + 1;
    if (!dalcs_builder_note_memory(
            builder,
            name != NULL &&
                dalcs_grow(&builder->elements.node_name, &builder->elements.node_name_capacity,
                           need, sizeof *builder->elements.node_name) == DALCS_OK &&
                dalcs_grow(&builder->elements.node_token, &builder->elements.node_token_capacity,
                           need, sizeof *builder->elements.node_token) == DALCS_OK)) {
        return -1;
    }
    builder->elements.node_name[node] = name;
    builder->elements.node_token[node] = token;
    builder->circuit->n_nodes++;
    return node;
}

int dalcs_builder_node(struct dalcs_builder *builder, const struct dalcs_token *token) {
    if (is_ground(token->text)) {
        return 0;
    }
    int node;
    const int next = builder->circuit->n_nodes;
    if (!dalcs_builder_note_memory(builder,
                                   dalcs_names_find_or_add(&builder->elements.nodes, token->text,
                                                           next, &node) == DALCS_OK)) {
        return -1;
    }
    return node < next ? node
                       : add_node(builder,
                                  dalcs_arena_copy(&builder->circuit->arena, token->text,
                                                   strlen(token->text)),
                                  token);
}

int dalcs_builder_inner_node(struct dalcs_builder *builder, const char *what,
                             const struct dalcs_token *element) {
    return add_node(builder,
                    dalcs_arena_printf(&builder->circuit->arena, "%s(%s)", what, element->text),
                    element);
}

/* x1:n1 as x1.n1, in scratch; NULL when out of memory. */
static char *with_dots(struct dalcs_builder *builder, const char *name) {
    char *copy = dalcs_arena_copy(&builder->scratch, name, strlen(name));
    dalcs_builder_note_memory(builder, copy != NULL);
    for (char *p = copy; p != NULL && *p != '\0'; p++) {
        *p = *p == ':' ? '.' : *p;
    }
    return copy;
}

/* A node by another of its names: x1:n1, or a port of a subcircuit. */
static int find_alias(struct dalcs_builder *builder, const char *name) {
    if (strpbrk(name, ".:") == NULL) {
        return -1;
    }
    const char *dotted = with_dots(builder, name);
    if (dotted == NULL) {
        return -1;
    }
    const char *port = dalcs_deck_port(builder->deck, dotted);
    const char *known = port != NULL ? port : dotted;
    return is_ground(known) ? 0 : dalcs_names_find(&builder->elements.nodes, known);
}

int dalcs_builder_look_up_node(struct dalcs_builder *builder, const char *name) {
    const int node = is_ground(name) ? 0 : dalcs_names_find(&builder->elements.nodes, name);
    return node < 0 ? find_alias(builder, name) : node;
}

/* How LTspice and KiCad call the node of a pin that no wire reaches: nc_01, unconnected-(u1-pad3). Nobody writes it, so
 * it is no slip where nothing else is connected to it. */
static bool is_open_pin(const char *name) {
    const char *dot = strrchr(name, '.');
    const char *own = dot != NULL ? dot + 1 : name;
    const size_t n_digits = strncmp(own, "nc_", 3) == 0 ? strspn(own + 3, "0123456789") : 0;
    return (n_digits > 0 && own[3 + n_digits] == '\0') || strncmp(own, "unconnected-(", 13) == 0;
}

int dalcs_builder_find_node(struct dalcs_builder *builder, const struct dalcs_token *token) {
    int node = dalcs_builder_look_up_node(builder, token->text);
    if (node < 0 && is_open_pin(token->text)) {
        dalcs_builder_warn(builder, token, "connect it",
                           "'%s' is a pin without a wire: it is read as 0 V here, as SPICE's gmin "
                           "would make it",
                           token->text);
        node = 0;
    }
    if (node < 0) {
        builder->failed = true;
        if ((builder->hidden & DALCS_HIDDEN_ELEMENTS) == 0) {
            dalcs_builder_error(
                builder, token,
                dalcs_builder_suggest(builder, &builder->elements.nodes, token->text, "nodes"),
                "no element is connected to a node '%s'", token->text);
        }
    }
    return node;
}

int dalcs_builder_find_node_or_warn(struct dalcs_builder *builder, const struct dalcs_token *token,
                                    const char *lost) {
    const int node = dalcs_builder_look_up_node(builder, token->text);
    if (node < 0 && (builder->hidden & DALCS_HIDDEN_ELEMENTS) != 0) {
        builder->failed = true;
    } else if (node < 0) {
        dalcs_builder_warn(
            builder, token,
            dalcs_builder_suggest(builder, &builder->elements.nodes, token->text, "nodes"),
            "no element is connected to a node '%s': %s", token->text, lost);
    }
    return node;
}

/* x1:d1 is x1.d1, and so are d.x1.d1 and d:x1:d1, as ngspice and LTspice call it. */
static int find_device_alias(struct dalcs_builder *builder, const char *name) {
    if (strpbrk(name, ".:") == NULL) {
        return -1;
    }
    const char *dotted = with_dots(builder, name);
    const int device = dotted != NULL ? dalcs_names_find(&builder->elements.devices, dotted) : -1;
    if (dotted == NULL || device >= 0 || dotted[1] != '.' || strrchr(dotted, '.')[1] != dotted[0]) {
        return device;
    }
    return dalcs_names_find(&builder->elements.devices, dotted + 2);
}

/* LTspice writes an element whose name does not begin with the letter of its kind as "b\u00a7vm", and
 * finds it by the name that was drawn, i(vm). -1 also when two elements were drawn so. */
static int find_drawn(struct dalcs_builder *builder, const char *name) {
    const char *dotted = with_dots(builder, name);
    if (dotted == NULL || builder->netlist->dialect.name != DALCS_DIALECT_LTSPICE) {
        return -1;
    }
    const char *dot = strrchr(dotted, '.');
    const char *drawn = dot != NULL ? dot + 1 : dotted;
    int found = -1;
    for (char letter = 'a'; letter <= 'z'; letter++) {
        const char *written = dalcs_builder_hint(builder, "%.*s%c\u00a7%s", (int)(drawn - dotted),
                                                 dotted, letter, drawn);
        const int device =
            written != NULL ? dalcs_names_find(&builder->elements.devices, written) : -1;
        if (device >= 0 && found >= 0) {
            return -1;
        }
        found = device >= 0 ? device : found;
    }
    return found;
}

int dalcs_builder_look_up_device(struct dalcs_builder *builder, const char *name) {
    int device = dalcs_names_find(&builder->elements.devices, name);
    device = device < 0 ? find_device_alias(builder, name) : device;
    return device < 0 ? find_drawn(builder, name) : device;
}

int dalcs_builder_find_device(struct dalcs_builder *builder, const struct dalcs_token *token) {
    const int device = dalcs_builder_look_up_device(builder, token->text);
    if (device >= 0 && device < builder->elements.n_device_cards) {
        return device;
    }
    builder->failed = true;
    if (device >= 0) {
        dalcs_builder_error(builder, token, NULL, "'%s' is a coupling, which has no terminals",
                            token->text);
    } else if ((builder->hidden & DALCS_HIDDEN_ELEMENTS) == 0) {
        dalcs_builder_error(
            builder, token,
            dalcs_builder_suggest(builder, &builder->elements.devices, token->text, "elements"),
            "there is no element '%s'", token->text);
    }
    return -1;
}

void dalcs_builder_add_name(struct dalcs_builder *builder, const struct dalcs_token *name,
                            int value) {
    int first;
    if (!dalcs_builder_note_memory(builder,
                                   dalcs_names_find_or_add(&builder->elements.devices, name->text,
                                                           value, &first) == DALCS_OK) ||
        first == value) {
        return;
    }
    dalcs_builder_error(builder, name, "give it another name",
                        "there are two elements '%s', the first at %s", name->text,
                        dalcs_builder_place(builder, builder->elements.device_token[first]));
}

char dalcs_builder_letter(const struct dalcs_token *name) {
    return dalcs_lower(name->line->text[name->offset]);
}

/* NULL when out of memory, which a name that is NULL is, too. */
static struct dalcs_device *add_device(struct dalcs_builder *builder, enum dalcs_device_kind kind,
                                       const char *name, const struct dalcs_token *token) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_device *device = &circuit->device[circuit->n_devices];
    device->kind = kind;
    device->stimulus = -1;
    device->control = -1;
    device->valve = -1;
    device->model = -1;
    device->name = name;
    device->where = dalcs_builder_keep_location(builder, token);
    if (!dalcs_builder_note_memory(builder, device->name != NULL)) {
        return NULL;
    }
    builder->elements.current_of[circuit->n_devices] = circuit->n_devices;
    builder->elements.device_token[circuit->n_devices] = token;
    circuit->n_devices++;
    return device;
}

struct dalcs_device *dalcs_builder_add_device(struct dalcs_builder *builder,
                                              enum dalcs_device_kind kind,
                                              const struct dalcs_token *name) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_device *device = add_device(
        builder, kind, dalcs_arena_copy(&circuit->arena, name->text, strlen(name->text)), name);
    if (device != NULL) {
        device->letter = dalcs_builder_letter(name);
        dalcs_builder_add_name(builder, name, circuit->n_devices - 1);
    }
    return device;
}

struct dalcs_device *dalcs_builder_add_inner_device(struct dalcs_builder *builder,
                                                    enum dalcs_device_kind kind, const char *what,
                                                    const struct dalcs_token *element) {
    struct dalcs_arena *arena = &builder->circuit->arena;
    return add_device(builder, kind, dalcs_arena_printf(arena, "%s(%s)", what, element->text),
                      element);
}

bool dalcs_builder_add_terminal(struct dalcs_builder *builder, const struct dalcs_token *element,
                                struct dalcs_device *device) {
    const int inside = dalcs_builder_inner_node(builder, "terminal", element);
    struct dalcs_device *terminal =
        dalcs_builder_add_inner_device(builder, DALCS_RESISTOR, "terminal", element);
    if (inside < 0 || terminal == NULL) {
        return false;
    }
    terminal->node[0] = device->node[0];
    terminal->node[1] = device->node[0] = inside;
    builder->elements.current_of[device - builder->circuit->device] =
        (int)(terminal - builder->circuit->device);
    return true;
}

const char *dalcs_builder_kind_text(enum dalcs_device_kind kind) {
    switch (kind) {
    case DALCS_RESISTOR:
        return "a resistor";
    case DALCS_INDUCTOR:
        return "an inductor";
    case DALCS_CAPACITOR:
        return "a capacitor";
    case DALCS_VSOURCE:
        return "a voltage source";
    case DALCS_ISOURCE:
        return "a current source";
    case DALCS_VCVS:
    case DALCS_CCCS:
    case DALCS_VCCS:
    case DALCS_CCVS:
        return "a controlled source";
    case DALCS_DIODE:
        return "a diode";
    case DALCS_SWITCH:
        return "a switch";
    }
    return "an element";
}
