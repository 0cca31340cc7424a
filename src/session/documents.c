/* documents.c - results of a session as JSON in memory. */
#include "check_json.h"
#include "report.h"
#include "session_internal.h"

#include <stdlib.h>
#include <string.h>

/* What a document is of; `check` alone has no session behind it. */
struct subject {
    const struct dalcs_report *report;
    enum dalcs_status status;
    const struct dalcs_check *check;
};

static enum dalcs_status write_document(struct dalcs_session *session,
                                        const struct subject *subject, const char **json) {
    size_t length = 0;
    *json = NULL;
    free(session->results.document);
    session->results.document = NULL;
    FILE *f = open_memstream(&session->results.document, &length);
    if (f == NULL) {
        return DALCS_E_NOMEM;
    }
    if (subject->check != NULL) {
        dalcs_check_write_json(f, subject->check);
    } else {
        dalcs_report_write(f, subject->report, subject->status);
    }
    bool lost = ferror(f) != 0;
    lost = fclose(f) != 0 || lost || session->results.document == NULL;
    *json = lost ? NULL : session->results.document;
    return lost ? DALCS_E_NOMEM : DALCS_OK;
}

enum dalcs_status dalcs_session_report_json(struct dalcs_session *session, const char **json) {
    *json = NULL;
    if (!session->results.has_report) {
        return DALCS_E_OPTION;
    }
    return write_document(
        session,
        &(struct subject){.report = &session->results.report, .status = session->results.ended},
        json);
}

enum dalcs_status dalcs_session_check_json(struct dalcs_session *session, double step,
                                           const char **json) {
    struct subject subject = {0};
    *json = NULL;
    DALCS_TRY(dalcs_session_check(session, step, &subject.check));
    return write_document(session, &subject, json);
}

static enum dalcs_status take_text(void *user, const char *suffix, const char *text,
                                   size_t length) {
    struct dalcs_session *session = user;
    (void)suffix;
    free(session->results.document);
    session->results.document = dalcs_alloc(length + 1, 1);
    if (session->results.document == NULL) {
        return DALCS_E_NOMEM;
    }
    memcpy(session->results.document, text, length);
    return DALCS_OK;
}

enum dalcs_status dalcs_session_equations_json(struct dalcs_session *session,
                                               enum dalcs_equations_form form, double step,
                                               const char **json) {
    *json = NULL;
    DALCS_TRY(dalcs_session_equations(
        session, &(struct dalcs_equations_options){.format = DALCS_EQUATIONS_JSON,
                                                   .form = form,
                                                   .step = step,
                                                   .user = session,
                                                   .file = take_text}));
    *json = session->results.document;
    return DALCS_OK;
}
