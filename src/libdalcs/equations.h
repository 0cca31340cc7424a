/* equations.h - systems given by matrices, and the equations of a netlist. Part of dalcs.h, which includes it. */
#ifndef LIBDALCS_EQUATIONS_H
#define LIBDALCS_EQUATIONS_H

#ifndef DALCS_H
#error "include dalcs.h"
#endif

/* Files that begin with "dalcs-system 2" are read by the calls of reading.h as well: a DALCS, an LCS or a
 * mechanical system given by its matrices (doc/system-file.md). */

/* The same from a program's own matrices: row by row and dense, NULL where all 0. Cards that have no
 * matrices, such as ".tran 1m 1\ninput u SIN(0 1 50)\n", are in `cards`, as in a system file. Copied:
 * nothing is borrowed after the call. */
struct dalcs_matrices {
    const char *title;
    const char *cards;
    size_t n_x, n_z, n_lambda, n_inputs; /* inputs: those of `cards`, in their order */
    const char *const *x_name;           /* [n_x]; NULL: x1, x2, ... */
    const char *const *z_name;           /* [n_z]; NULL: z1, z2, ... */
    const double *x0;                    /* [n_x]; NULL: .tran starts from its operating point */
    const double *low, *high; /* [n_lambda] of the cones: 0 and INFINITY a half line, both infinite
                                 free, both finite a box; NULL: 0 and INFINITY */
    const double *P;          /* [n_x][n_x]; NULL: the identity */
    const double *A_I, *B_I, *Bbar_I, *E_I, *constant_I;      /* n_x rows; constants [n_x] */
    const double *A_II, *B_II, *Bbar_II, *E_II, *constant_II; /* n_z rows */
    const double *C_I, *C_II, *D, *F, *constant_F;            /* n_lambda rows */
    const double *storage; /* [n_x][n_x] of the stored energy 1/2 x' storage x; NULL: P */
};
enum dalcs_status
dalcs_session_read_matrices(struct dalcs_session *session, const char *name,
                            const struct dalcs_matrices *matrices) DALCS_MUST_CHECK;

/* A mechanical system, mass q'' + damping q' + stiffness q = force s(t) + constant_force + G' lambda. The rows
 * of G and constant_G are those of the contacts (0 <= lambda _|_ G q + c >= 0, impacts are inelastic), then of
 * the joints (0 = G q + c), then of the frictions (|lambda| <= limit against G q' + c). Row by row and dense,
 * NULL where all 0; units are the caller's. Copied. */
struct dalcs_mechanics {
    const char *title;
    const char *cards; /* as above */
    size_t n_q, n_inputs, n_contacts, n_joints, n_frictions;
    const char *const *q_name; /* [n_q]; NULL: q1, q2, ...; velocities are d(NAME) */
    const double *q0, *v0;     /* [n_q]; both NULL: .tran starts from its operating point */
    const double *mass, *damping, *stiffness; /* [n_q][n_q]; NULL: of mass the identity */
    const double *force, *constant_force;     /* [n_q][n_inputs], [n_q] */
    const double *G, *constant_G;             /* n_contacts + n_joints + n_frictions rows */
    const double *friction_limit;             /* [n_frictions] */
};
enum dalcs_status
dalcs_session_read_mechanics(struct dalcs_session *session, const char *name,
                             const struct dalcs_mechanics *mechanics) DALCS_MUST_CHECK;

enum dalcs_equations_format {
    DALCS_EQUATIONS_TEXT,
    DALCS_EQUATIONS_LATEX,
    DALCS_EQUATIONS_SYSTEM, /* a system file, which is read back to the bit; so are the next two */
    DALCS_EQUATIONS_JSON,
    DALCS_EQUATIONS_MATRIX_MARKET /* a system file with its matrices in files beside it */
};

enum dalcs_equations_form {
    DALCS_FORM_DALCS,   /* (2.1) of Brogliato 2022 */
    DALCS_FORM_LCS,     /* z eliminated where B_II is regular; a message says where it is not */
    DALCS_FORM_ONE_STEP /* (3.2) for a step: w = M lambda + q */
};

struct dalcs_equations_options {
    enum dalcs_equations_format format;
    enum dalcs_equations_form form;
    double step;      /* s, of DALCS_FORM_ONE_STEP */
    const char *stem; /* of Matrix Market: what its files' names begin with; without folders */
    void *user;
    /* Receives each file: "" or ".json" are no part of `suffix`, which is "" for the first and
     * ".A_I.mtx" for a matrix. Text is borrowed until the callback returns. */
    enum dalcs_status (*file)(void *user, const char *suffix, const char *text, size_t length);
};

/* Writes the equations of what was read. */
enum dalcs_status
dalcs_session_equations(struct dalcs_session *session,
                        const struct dalcs_equations_options *options) DALCS_MUST_CHECK;

#endif
