/* ledger.h -- the energy book of a solid, for tests that need one entry of it in an expression. */
#pragma once
#include "bw_check.h"
#include "bw_pd_bond.h"

/* Fails the test where the book cannot be made. Collective. */
static inline bw_pd_bond_ledger ledger_of(bw_pd_bond *pd)
{
  bw_pd_bond_ledger ledger = {0};
  bw_check_ok(bw_pd_bond_account(pd, &ledger));
  return ledger;
}
