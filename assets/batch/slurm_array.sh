#!/bin/bash
# A list of jobs as a Slurm array: sbatch slurm_array.sh jobs.jsonl OUT
# Each task takes the lines of its own number; a task that is requeued goes on where it was. When all are done:
#   understudy batch jobs.jsonl --out OUT --merge all.csv
#SBATCH --job-name=understudy
#SBATCH --array=0-7
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --mem-per-cpu=500M
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=understudy-%A_%a.log
exec srun "${UNDERSTUDY:-understudy}" batch "$1" --out "$2" --jobs "${SLURM_CPUS_PER_TASK:-1}"
