#!/bin/sh
# campaign.sh
#SBATCH --ntasks=4 --cpus-per-task=1
#SBATCH --output=campaign.txt
[ -e out/drawer/journal.ndjson ] && resume=--resume
exec parallax run cases/drawer.yaml --out out/drawer $resume \
  --launcher 'srun --quiet --exact -n1 -c1' --jobs "$SLURM_NTASKS"
