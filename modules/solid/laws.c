/* The table of laws: those that a case file can name. A law is one row more. */
#include "bw_solid.h"
#include "pd_law.h"

#include <string.h>

const bw_pd_law *const bw_solid_laws[] = {&bw_pd_bond_law, &bw_pd_state_ordinary_law,
                                          &bw_pd_state_correspondence_law, NULL};

const bw_pd_law *bw_solid_law_by_name(const char *name)
{
  for (const bw_pd_law *const *law = bw_solid_laws; *law != NULL; law++)
    if (strcmp((*law)->name, name) == 0) return *law;
  return NULL;
}

void bw_solid_laws_describe(FILE *out)
{
  for (const bw_pd_law *const *law = bw_solid_laws; *law != NULL; law++) {
    fprintf(out, "%s\n", (*law)->name);
    for (const bw_pd_law_key *key = (*law)->keys; key->name != NULL; key++)
      fprintf(out, "  %-20s %s%s%s%s\n", key->name, key->meaning, *key->unit != '\0' ? " [" : "",
              key->unit, *key->unit != '\0' ? "]" : "");
  }
}
