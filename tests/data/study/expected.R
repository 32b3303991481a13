# What R says of the answers beside this file, into expected.csv and studentised_range.csv: Rscript expected.R
# Nothing but base R: alignment and ranks are written out here, the tests are R's aov, TukeyHSD and ptukey.
invisible(Sys.setlocale("LC_COLLATE", "C"))
options(contrasts = c("contr.sum", "contr.poly"))

answers_of <- function(folder) {
  files <- list.files(folder, "\\.csv$", full.names = TRUE)
  do.call(rbind, lapply(files, read.csv, colClasses = c(answer = "character")))
}

# One value for each participant and cell.
averaged <- function(answers, factors) {
  answers$y <- as.numeric(answers$answer)
  data <- aggregate(answers["y"], answers[c("participant", factors)], mean)
  for (name in c("participant", factors)) data[[name]] <- factor(data[[name]])
  data
}

mean_by <- function(data, factors) if (length(factors) == 0) ave(data$y) else do.call(ave, c(list(data$y), data[factors]))
subsets <- function(x) if (length(x) == 0) list(character(0)) else {
  rest <- subsets(x[-1])
  c(rest, lapply(rest, function(s) c(x[1], s)))
}

# Wobbrock et al. 2011: residual of the cell plus the estimated effect, ranked.
aligned_rank <- function(data, factors, effect) {
  estimate <- Reduce(`+`, lapply(subsets(effect), function(s) (-1)^(length(effect) - length(s)) * mean_by(data, s)))
  rank(round(data$y - mean_by(data, factors) + estimate, 8))
}
# Elkin et al. 2021: the effect's factors as one.
contrast_rank <- function(data, factors, effect) {
  rank(round(data$y - mean_by(data, factors) + mean_by(data, effect) - mean(data$y), 8))
}

test_of <- function(data, factors, effect) {
  fit <- aov(as.formula(sprintf("y ~ %s + Error(participant/(%s))", paste(factors, collapse = "*"),
                                paste(factors, collapse = "*"))), data = data)
  table <- summary(fit)[[paste0("Error: participant:", paste(effect, collapse = ":"))]][[1]]
  c(F = table[1, "F value"], df1 = table[1, "Df"], df2 = table[2, "Df"], p = table[1, "Pr(>F)"],
    eta2p = table[1, "Sum Sq"] / sum(table[, "Sum Sq"]))
}

tukey_of <- function(data, effect) {
  data$x <- interaction(data[effect], sep = ", ", lex.order = TRUE)
  one <- aggregate(data["y"], data[c("participant", "x")], mean)
  fit <- aov(y ~ x + participant, data = one)
  table <- TukeyHSD(fit, "x")$x
  k <- nlevels(one$x)
  error <- sqrt(2 * deviance(fit) / df.residual(fit) / nlevels(one$participant))
  pairs <- combn(levels(one$x), 2)  # TukeyHSD has them in the same order, second minus first
  t <- -table[, "diff"] / error
  p <- ptukey(abs(t) * sqrt(2), k, df.residual(fit), lower.tail = FALSE)
  stopifnot(abs(p - table[, "p adj"]) < 1e-6, rownames(table) == paste(pairs[2, ], pairs[1, ], sep = "-"))
  data.frame(a = pairs[1, ], b = pairs[2, ], t = t, df2 = df.residual(fit), p = p)
}

row_of <- function(set, kind, effect, a = "", b = "", F = NA, df1 = NA, df2 = NA, p = NA, eta2p = NA, t = NA)
  data.frame(set, kind, effect = paste(effect, collapse = ":"), a, b, F, df1, df2, p, eta2p, t)

analysed <- function(set, answers, factors) {
  data <- averaged(answers, factors)
  rows <- NULL
  for (effect in setdiff(subsets(factors), list(character(0)))) {
    plain <- test_of(data, factors, effect)
    ranks <- data; ranks$y <- aligned_rank(data, factors, effect)
    art <- test_of(ranks, factors, effect)
    rows <- rbind(rows, do.call(row_of, c(list(set, "anova", effect), as.list(plain))),
                  do.call(row_of, c(list(set, "art", effect), as.list(art))))
    ranks$y <- contrast_rank(data, factors, effect)
    for (kind in c("tukey", "artc")) {
      pairs <- tukey_of(if (kind == "tukey") data else ranks, effect)
      if (nrow(pairs) <= 66)
        rows <- rbind(rows, row_of(set, kind, effect, pairs$a, pairs$b, t = pairs$t, df2 = pairs$df2, p = pairs$p))
    }
  }
  quartiles <- tapply(as.numeric(answers$answer), answers[[factors[1]]], quantile, c(0.25, 0.5, 0.75))
  for (level in names(quartiles))  # F: median, df1 and df2: quartiles
    rows <- rbind(rows, row_of(set, "median", factors[1], level, F = quartiles[[level]][2],
                               df1 = quartiles[[level]][1], df2 = quartiles[[level]][3]))
  rows
}

exclusions <- answers_of("exclusions")
asked <- exclusions[exclusions$question == "action", ]
share <- tapply(asked$answer == asked$motion, asked$participant, mean)
missing <- unique(exclusions$participant[is.na(exclusions$answer) | exclusions$answer == ""])
kept <- setdiff(names(share)[share >= 0.5], missing)
stopifnot(length(kept) == 11)

rows <- rbind(
  analysed("slider", answers_of("slider"), c("method", "motion")),
  analysed("likert", answers_of("likert"), c("method", "motion", "shape")),
  analysed("exclusions", exclusions[exclusions$question == "shape" & exclusions$participant %in% kept, ],
           c("method", "motion")))
number <- sapply(rows, is.numeric)
rows[number] <- lapply(rows[number], function(x) ifelse(is.na(x), "", format(signif(x, 10), digits = 10, trim = TRUE, scientific = NA)))
rows[number] <- lapply(rows[number], trimws)
write.table(rows, "expected.csv", sep = ",", quote = c(3, 4, 5), row.names = FALSE)

# The studentised range by its double integral with R's integrate: ptukey itself is off by 1e-4 at 2 degrees of freedom
# and by 1e-6 for many means.
range_tail <- function(w, k) k * integrate(function(z) {
  share <- pmin(pnorm(z - w) / pnorm(z), 1)
  dnorm(z) * pnorm(z)^(k - 1) * -expm1((k - 1) * log1p(-share))
}, w / 2 - 9, w / 2 + 9, rel.tol = 1e-11, abs.tol = 0, subdivisions = 1000)$value
studentised_tail <- function(q, k, df) {
  constant <- log(2) + df / 2 * log(df / 2) - lgamma(df / 2)
  density <- function(s) exp(constant + (df - 1) * log(s) - df * s^2 / 2)
  product <- function(s) sapply(s, function(x) density(x) * min(range_tail(q * x, k), 1))
  edges <- c(1e-12, sqrt((df - 1) / (df + q^2 / 2)), 1, 1 + 10 / sqrt(df))
  sum(sapply(1:3, function(i) integrate(product, edges[i], edges[i + 1], rel.tol = 1e-10, abs.tol = 0, subdivisions = 2000)$value))
}
range <- expand.grid(q = c(0.1, 0.5, 1, 2, 3, 3.5, 4, 5, 7, 10), k = c(2, 3, 5, 10, 45), df = c(2, 3, 8, 20, 58, 140, 1592))
range$ptukey <- sprintf("%.12g", ptukey(range$q, range$k, range$df, lower.tail = FALSE))
range$integral <- sprintf("%.12g", mapply(studentised_tail, range$q, range$k, range$df))
write.table(range, "studentised_range.csv", sep = ",", quote = FALSE, row.names = FALSE)
