/* ledger.h -- the energy book of a solid, for tests that need one entry of it in an expression. */
#pragma once
#include "bw_check.h"
#include "bw_solid.h"

/* Fails the test where the book cannot be made. Collective. */
static inline bw_solid_ledger ledger_of(bw_solid *pd)
{
  bw_solid_ledger ledger = {0};
  bw_check_ok(bw_solid_account(pd, &ledger));
  return ledger;
}
