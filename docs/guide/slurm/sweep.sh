#!/bin/sh
# sweep.sh
#SBATCH --array=1-8 --ntasks=1 --cpus-per-task=1
#SBATCH --output=out/sweep-%a.txt
seed=$(( (SLURM_ARRAY_TASK_ID - 1) / 4 + 1 ))
part=$(( (SLURM_ARRAY_TASK_ID - 1) % 4 + 1 ))
exec parallax suite scenarios --seed "$seed" --shard "$part/4" --out "out/seed-$seed/$part"
