/* transformer.c - ideal transformers: an A card with two nodes for each winding.
 *
 *     Aname a1 b1 a2 b2 ... model         .model name transformer(turns=[n1 n2 ...])
 *
 *     v_k/n_k is the same of all windings, and n_1 i_1 + n_2 i_2 + ... = 0
 *
 * Each winding after the first is a voltage source of n_k/n_1 times the first one's voltage, and beside the first one a
 * current source takes n_k/n_1 times its current. Together they add a skew-symmetric matrix, so that a circuit is as
 * passive as it is without them. */
#include "block.h"
#include "reader.h"

static const char USAGE[] =
    "a transformer is: Aname a1 b1 a2 b2 ... model, two nodes for each of its turns=[n1 n2 ...]";

/* Winding k, from node[2 k] to node[2 k + 1]; the first one's current source is the element for k = 1. */
static bool add_winding(struct dalcs_builder *builder, const struct dalcs_token *name,
                        struct dalcs_device *device, const int *node, int k, double ratio) {
    const char *what = dalcs_builder_hint(builder, "winding%d", k + 1);
    const char *share = dalcs_builder_hint(builder, "ampere_turns%d", k + 1);
    if (what == NULL || share == NULL) {
        return false;
    }
    struct dalcs_device *voltage = dalcs_builder_add_inner_device(builder, DALCS_VCVS, what, name);
    struct dalcs_device *current =
        k == 1 ? device : dalcs_builder_add_inner_device(builder, DALCS_CCCS, share, name);
    if (voltage == NULL || current == NULL) {
        return false;
    }
    voltage->node[0] = node[2 * k];
    voltage->node[1] = node[2 * k + 1];
    voltage->node[2] = current->node[0] = device->node[0];
    voltage->node[3] = current->node[1] = device->node[1];
    voltage->value = ratio;
    current->kind = DALCS_CCCS;
    current->control = (int)(voltage - builder->circuit->device);
    current->value = -ratio;
    voltage->is_transformer = current->is_transformer = true;
    return true;
}

static const struct dalcs_block_value *read_turns(struct dalcs_builder *builder,
                                                  const struct dalcs_card *card,
                                                  const struct dalcs_block *block) {
    static const char *const names[] = {"turns"};
    const struct dalcs_block_card c = {.builder = builder, .card = card, .block = block};
    const struct dalcs_block_value *turns = dalcs_block_find(block, "turns");
    const int n_nodes = card->n - 2;
    if (!dalcs_block_has_only(&c, names, 1)) {
        return NULL;
    }
    if (turns == NULL || turns->n == 0) {
        dalcs_builder_error(builder, block->name, "turns=[10 5 5] are three windings",
                            "the transformer '%s' has no turns=", block->name->text);
        return NULL;
    }
    for (int k = 0; k < turns->n; k++) {
        if (turns->number[k] == 0) {
            dalcs_builder_error(builder, turns->name, "leave the winding out",
                                "a winding of the transformer '%s' has no turns",
                                block->name->text);
            return NULL;
        }
    }
    if (n_nodes != 2 * turns->n) {
        dalcs_builder_error(builder, card->token, USAGE,
                            "'%s' has %d node%s, a transformer of %d winding%s has %d",
                            card->token->text, n_nodes, n_nodes == 1 ? "" : "s", turns->n,
                            turns->n == 1 ? "" : "s", 2 * turns->n);
        return NULL;
    }
    return turns;
}

void dalcs_transformer_parse(struct dalcs_builder *builder, const struct dalcs_card *card,
                             const struct dalcs_block *block) {
    const struct dalcs_block_value *turns = read_turns(builder, card, block);
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_device *device =
        turns != NULL ? dalcs_builder_add_device(builder, DALCS_ISOURCE, card->token) : NULL;
    int *node = dalcs_arena_alloc(&builder->scratch, (size_t)card->n, sizeof *node);
    if (device == NULL || node == NULL || !dalcs_reader_nodes(&reader, card->n - 2, node)) {
        builder->hidden |= DALCS_HIDDEN_ELEMENTS;
        return;
    }
    device->node[0] = node[0];
    device->node[1] = node[1];
    if (turns->n == 1) { /* without another one it takes no current */
        struct dalcs_circuit *circuit = builder->circuit;
        device->stimulus = circuit->n_stimuli++;
        circuit->stimulus[device->stimulus] =
            (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .has_dc = true};
        return;
    }
    if (turns->n > 2 && !dalcs_builder_add_terminal(builder, card->token, device)) {
        return;
    }
    for (int k = 1; k < turns->n; k++) {
        if (!add_winding(builder, card->token, device, node, k,
                         turns->number[k] / turns->number[0])) {
            return;
        }
    }
}
