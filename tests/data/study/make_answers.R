# Writes the three folders of answers that stand beside this file: Rscript make_answers.R
#   slider      12 participants, 3 methods x 2 motions, a scale from 0 to 100 without ties
#   likert      10 participants, 3 methods x 2 motions x 2 shapes, two repetitions, 7 points, many ties
#   exclusions  14 participants, 3 methods x 3 motions, 7 points and a question of attention; two were not
#               attentive, one left an answer out
invisible(Sys.setlocale("LC_COLLATE", "C"))
suppressWarnings(RNGversion("3.6.0"))

write_answers <- function(folder, participant, rows) {
  dir.create(folder, showWarnings = FALSE)
  rows$trial <- match(rows$trial, unique(rows$trial))
  rows <- cbind(participant = participant, rows)
  write.table(rows, file.path(folder, paste0(participant, ".csv")), sep = ",", quote = FALSE, row.names = FALSE)
}

answered <- function(design, question, answer) {
  n <- nrow(design)
  data.frame(trial = paste0("t", seq_len(n)), question = question, answer = answer,
             rt_ms = round(runif(n, 900, 6000)), replays = rpois(n, 0.4),
             shown_at = sprintf("2024-05-02T10:%02d:%02d", seq_len(n) %/% 4, seq_len(n) * 13 %% 60), design)
}

shuffled <- function(design) design[sample(nrow(design)), , drop = FALSE]
likert <- function(x) pmin(pmax(round(x), 1), 7)
better <- c(ours = 0.8, H4D = -0.5, TST = 0.3)
methods <- names(better)
motions <- c("walk", "hip-hop", "throw")

set.seed(41)
for (i in 1:12) {
  design <- shuffled(expand.grid(method = methods, motion = motions[1:2], stringsAsFactors = FALSE))
  score <- 45 + rnorm(1, 0, 8) + 6 * better[design$method] + ifelse(design$motion == "walk", 4, 0) +
    ifelse(design$motion == "walk" & design$method == "TST", 7, 0) + rnorm(6, 0, 8)
  write_answers("slider", sprintf("S%02d", i), answered(design, "naturalness", round(score, 3)))
}

set.seed(42)
for (i in 1:10) {
  design <- shuffled(expand.grid(method = methods, motion = motions[1:2], shape = c("child", "tall man"),
                                 repetition = 1:2, stringsAsFactors = FALSE))
  score <- 4 + rnorm(1, 0, 0.8) + better[design$method] + ifelse(design$shape == "child", -0.4, 0) +
    ifelse(design$method == "ours" & design$motion == "walk", 0.7, 0) + rnorm(nrow(design), 0, 1.1)
  write_answers("likert", sprintf("L%02d", i), answered(design, "motion", likert(score)))
}

set.seed(43)
for (i in 1:14) {
  design <- shuffled(expand.grid(method = methods, motion = motions, stringsAsFactors = FALSE))
  score <- 4 + rnorm(1, 0, 0.8) + better[design$method] + ifelse(design$motion == "throw", -0.8, 0) +
    rnorm(nrow(design), 0, 1.1)
  action <- design$motion
  wrong <- if (i %in% c(4, 11)) 1:6 else if (i == 2) 1:4 else integer(0)
  action[wrong] <- ifelse(action[wrong] == "walk", "throw", "walk")
  rows <- rbind(answered(design, "shape", likert(score)), answered(design, "action", action))
  if (i == 7) rows$answer[5] <- ""
  write_answers("exclusions", sprintf("E%02d", i), rows)
}
