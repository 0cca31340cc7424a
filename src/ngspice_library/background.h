/* background.h - one thread that runs while the program goes on. */
#ifndef DALCS_NG_BACKGROUND_H
#define DALCS_NG_BACKGROUND_H

#include "dalcs.h"
#include "ngspice_abi.h"

#include <pthread.h>

enum ng_state {
    NG_IDLE,
    NG_RUNNING,
    NG_HALTING, /* it stops at the solver's next progress call */
    NG_HALTED,
    NG_CANCELLING
};

/* Zero-initialise, set the first three, then open. */
struct ng_background {
    ng_thread_state *_Atomic tell; /* of the program; may be NULL; read once for a call */
    int id;
    void *user;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    enum ng_state state; /* behind the lock */
    pthread_t thread;
    bool has_thread; /* that has not been joined */
    void (*work)(void *argument, const char *command);
    void *argument;
    char *command; /* heap */
};

enum dalcs_status ng_background_open(struct ng_background *background) DALCS_MUST_CHECK;

/* Cancels what runs and waits for its end. false: it does not come. A process that ends must not wait for ever:
 * the thread may be in a callback of a language that has ended already. */
bool ng_background_close(struct ng_background *background);

/* Executes work(argument, command) in the thread. */
enum dalcs_status ng_background_start(struct ng_background *background,
                                      void (*work)(void *argument, const char *command),
                                      void *argument, const char *command) DALCS_MUST_CHECK;

bool ng_background_is_running(struct ng_background *background);
bool ng_background_is_halted(struct ng_background *background);

/* Is the caller that thread? */
bool ng_background_is_here(const struct ng_background *background);

/* Returns when the thread stands still. false: nothing runs. */
bool ng_background_halt(struct ng_background *background);
bool ng_background_resume(struct ng_background *background);

/* Ends what was halted, and waits until a thread that is done has gone. */
void ng_background_end(struct ng_background *background);

/* Asked between steps: waits while it is halted. DALCS_E_CANCELLED: stop. */
enum dalcs_status ng_background_pause(struct ng_background *background) DALCS_MUST_CHECK;

#endif
