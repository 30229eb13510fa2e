#include "core/search/mpi/ranks.h"

#include <vector>

#include <mpi.h>

extern "C" {

__attribute__((visibility("default"))) bool lumorphRanksJoin(LumorphRanks* ranks) {
    int given = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given) != MPI_SUCCESS) return false;
    MPI_Comm_rank(MPI_COMM_WORLD, &ranks->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks->count);
    return given >= MPI_THREAD_FUNNELED;
}

__attribute__((visibility("default"))) int lumorphRanksMost(int mine) {
    int most = mine;
    MPI_Allreduce(&mine, &most, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    return most;
}

__attribute__((visibility("default"))) void lumorphRanksShare(const double* mine, double* all, const int* counts) {
    int rank = 0;
    int size = 1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    std::vector<int> starts(static_cast<std::size_t>(size), 0);
    for (std::size_t k = 1; k < starts.size(); ++k) starts[k] = starts[k - 1] + counts[k - 1];
    MPI_Allgatherv(mine, counts[rank], MPI_DOUBLE, all, counts, starts.data(), MPI_DOUBLE, MPI_COMM_WORLD);
}

__attribute__((visibility("default"))) void lumorphRanksLeave() { MPI_Finalize(); }
}
