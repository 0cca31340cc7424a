/* reading.h - a system file while it is being read: cards to columns and blocks, blocks to systems.
 * Private to this folder.
 *
 * A person's columns are states, unknowns and multipliers. A multiplier may lie in a half line, a box
 * or be free; the engine knows pairs alone, so that some multipliers become two pairs or an unknown. */
#ifndef DALCS_READING_H
#define DALCS_READING_H

#include "description.h"
#include "reader.h"

/* A state, an unknown or a row. */
struct dalcs_described_column {
    const char *name;
    enum dalcs_label_kind kind;
    bool is_current;
    bool has_initial;
    double initial;
    int root; /* column of the tree's root, -1: itself */
    int dual; /* of a row: its column, -1: the one of its number */
};

enum dalcs_cone {
    DALCS_CONE_HALF_LINE, /* 0 <= lambda _|_ w >= 0, or a switch */
    DALCS_CONE_BOX,       /* low <= lambda <= high, w against it at the bounds, 0 between */
    DALCS_CONE_FREE       /* lambda free, w = 0 */
};

/* What w is of in a mechanical system. */
enum dalcs_constraint { DALCS_NO_CONSTRAINT, DALCS_CONTACT, DALCS_BILATERAL, DALCS_FRICTION };

struct dalcs_multiplier {
    enum dalcs_cone cone;
    enum dalcs_constraint constraint;
    double low, high; /* of a box; at least one is finite */
    struct dalcs_pair pair;
};

enum dalcs_block_name {
    DALCS_BLOCK_P,
    DALCS_BLOCK_A_I,
    DALCS_BLOCK_B_I,
    DALCS_BLOCK_BBAR_I,
    DALCS_BLOCK_E_I,
    DALCS_BLOCK_CONSTANT_I,
    DALCS_BLOCK_A_II,
    DALCS_BLOCK_B_II,
    DALCS_BLOCK_BBAR_II,
    DALCS_BLOCK_E_II,
    DALCS_BLOCK_CONSTANT_II,
    DALCS_BLOCK_C_I,
    DALCS_BLOCK_C_II,
    DALCS_BLOCK_D,
    DALCS_BLOCK_F,
    DALCS_BLOCK_CONSTANT_F,
    DALCS_BLOCK_STORAGE,
    DALCS_BLOCK_CONTROL,
    DALCS_BLOCK_DIRECT_CONTROL,
    DALCS_BLOCK_MASS,
    DALCS_BLOCK_DAMPING,
    DALCS_BLOCK_STIFFNESS,
    DALCS_BLOCK_FORCE,
    DALCS_BLOCK_CONSTANT_FORCE,
    DALCS_BLOCK_G,
    DALCS_BLOCK_CONSTANT_G,
    DALCS_N_BLOCKS
};

/* Free, or between two bounds: an unknown of the engine, whose multipliers are pairs. */
bool dalcs_multiplier_is_unknown(const struct dalcs_multiplier *multiplier);

/* The properties of the OSNSP that a file declares. */
enum dalcs_claim { DALCS_CLAIM_NOTHING, DALCS_CLAIM_YES, DALCS_CLAIM_NO };

/* A matrix of the file: its card, then, when all columns are known, its entries from 0 on. */
struct dalcs_block {
    const struct dalcs_card *card; /* NULL: not given, all 0 */
    struct dalcs_triplets entries;
};

struct dalcs_described_system {
    const struct dalcs_token *token; /* its first card */
    size_t n_states, n_unknowns, n_rows, n_multipliers;
    size_t state_capacity, unknown_capacity, row_capacity, multiplier_capacity;
    struct dalcs_described_column *state, *unknown, *row;
    struct dalcs_multiplier *multiplier;
    size_t n_inputs, input_capacity; /* the matrices' columns of inputs */
    int *input;                      /* in the file */
    bool names_inputs;               /* false: all of the file, as far as they are used */
    struct dalcs_block block[DALCS_N_BLOCKS];
    size_t n_coordinates; /* of a mechanical system: its states are these and their velocities */
    enum dalcs_claim monotone;
    bool jumps_are_covered; /* by the networks of jumps in the file */
};

struct dalcs_reading {
    struct dalcs_builder builder;
    struct dalcs_description *description;
    size_t n_inputs; /* without the constant 1 */
    size_t input_capacity;
    const char **input_name;
    struct dalcs_stimulus *input;
    const struct dalcs_token **input_token;

    struct dalcs_network *network; /* being filled */
    size_t n_systems, system_capacity;
    struct dalcs_described_system *system; /* of this network */
    struct dalcs_output *output;           /* heap */
    size_t n_outputs, output_capacity;
    struct dalcs_state *element;
    size_t n_elements, element_capacity;
    bool has_units; /* V or A stands on some card */
};

/* ---- read_columns.c: cards that name columns ------------------------------------------------- */

/* A card of a system that is no matrix; false: it is none of these. */
bool dalcs_reading_take_column(struct dalcs_reading *r, struct dalcs_described_system *s,
                               const struct dalcs_card *card);

/* An `input` card. */
void dalcs_reading_take_input(struct dalcs_reading *r, const struct dalcs_card *card);

/* One more system, which begins at this card; NULL: out of memory. The system that a card belongs to: the last one, or the
 * first. */
struct dalcs_described_system *dalcs_reading_new_system(struct dalcs_reading *r,
                                                        const struct dalcs_card *card);
struct dalcs_described_system *dalcs_reading_present_system(struct dalcs_reading *r,
                                                            const struct dalcs_card *card);
void dalcs_reading_drop_system(struct dalcs_described_system *s);

/* network main|charge|flux|held; false when an error was reported. Then everything between two of these cards. */
bool dalcs_reading_begin_network(struct dalcs_reading *r, const struct dalcs_card *card);
enum dalcs_status dalcs_reading_finish_network(struct dalcs_reading *r,
                                               const struct dalcs_card *card,
                                               size_t n_cards) DALCS_MUST_CHECK;

/* An `output` or `element` card: read when its network is. */
bool dalcs_reading_is_output(const struct dalcs_card *card);

/* A name on a card: any word or string, kept. NULL when an error was reported. */
const char *dalcs_reading_name(struct dalcs_reader *reader, const char *what);

/* read_switch.c: what follows its name. false when an error was reported. */
bool dalcs_reading_switch(struct dalcs_reader *reader, struct dalcs_pair *p);

/* V or A, else as it was. */
void dalcs_reading_take_unit(struct dalcs_reading *r, struct dalcs_reader *reader,
                             bool *is_current);

/* ---- read_matrices.c ------------------------------------------------------------------------ */

/* Is this the name of a matrix? */
bool dalcs_reading_is_matrix(const char *name);

/* Keeps the card `matrix NAME ...`. */
void dalcs_reading_take_matrix(struct dalcs_reading *r, struct dalcs_described_system *s,
                               const struct dalcs_card *card);

/* Reads the entries of all blocks: the sizes are those of the columns. */
enum dalcs_status dalcs_reading_fill_blocks(struct dalcs_reading *r,
                                            struct dalcs_described_system *s) DALCS_MUST_CHECK;

/* ---- matrix_market.c ------------------------------------------------------------------------ */

/* A file of n_rows by n_columns: coordinate or array, real or integer, general or symmetric. False when
 * an error was reported at `token`, the name of the file. */
bool dalcs_matrix_market_read(struct dalcs_builder *builder, const struct dalcs_token *token,
                              int n_rows, int n_columns, struct dalcs_triplets *entries);

/* ---- mechanical.c, cones.c, monotone.c ------------------------------------------------------ */

/* A mechanical system becomes one of first order: coordinates, then velocities. */
enum dalcs_status
dalcs_mechanical_to_first_order(struct dalcs_reading *r,
                                struct dalcs_described_system *s) DALCS_MUST_CHECK;

/* Fills *system, and *initial[n_x], from what was described. Names are the circuit's. */
enum dalcs_status dalcs_system_of_description(struct dalcs_reading *r,
                                              struct dalcs_described_system *s,
                                              struct dalcs_system *system,
                                              double **initial) DALCS_MUST_CHECK;

/* Sets system->monotone: as the claim says, else if eigenvalues show that the OSNSP is monotone for every
 * step. */
enum dalcs_status dalcs_system_prove_monotone(struct dalcs_system *system,
                                              enum dalcs_claim claim) DALCS_MUST_CHECK;

/* ---- read_outputs.c ------------------------------------------------------------------------- */

/* A card `output` or `element` of the present network. */
void dalcs_reading_take_output(struct dalcs_reading *r, const struct dalcs_card *card);

/* All columns and every w of the network's systems, where no card names outputs. */
enum dalcs_status dalcs_reading_default_outputs(struct dalcs_reading *r) DALCS_MUST_CHECK;

/* ---- json_cards.c --------------------------------------------------------------------------- */

/* The cards of the JSON form, as text that the caller frees. */
enum dalcs_status dalcs_json_to_cards(const char *name, const char *text, size_t length,
                                      char **cards, size_t *n,
                                      struct dalcs_diag *diag) DALCS_MUST_CHECK;

#endif
