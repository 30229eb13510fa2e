#pragma once

/// The plain C side of a library that is loaded only where a program runs under `mpirun`, so that nothing else needs
/// MPI (MPI Forum, "MPI: A Message-Passing Interface Standard", 3.1). All ranks call the same functions in the same
/// order. Only this header is shared by the two sides.
extern "C" {

struct LumorphRanks {
    int rank;  ///< of this process
    int count; ///< of all
};

/// Joins the other ranks; false when MPI refuses.
using LumorphRanksJoin = bool (*)(LumorphRanks* ranks);
/// The largest of all ranks' numbers, to each of them.
using LumorphRanksMost = int (*)(int mine);
/// Puts what each rank has, `counts[rank]` numbers, one after another into `all`, on each of them.
using LumorphRanksShare = void (*)(const double* mine, double* all, const int* counts);
/// Leaves, once all have.
using LumorphRanksLeave = void (*)();
}
