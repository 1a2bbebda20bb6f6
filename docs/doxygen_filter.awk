# doxygen_filter.awk -- our headers as Doxygen wants them, on standard output.
#
# Headers of Breakwater are written for people who open them in an editor: comments are plain.
# What a comment belongs to follows from where it stands, and this filter says so to Doxygen:
#   the block at the head of a file             the page of the file, laid out as it stands
#   a comment on the lines above a declaration  that declaration, and those that follow it without
#                                               a blank line between (a group has one comment)
#   a comment behind a declaration              that declaration, besides what stands above it
#   the same inside a struct or an enum         the member, or each of the members of the line
#   a comment between blank lines               the page of the file again
# Comments in bodies of functions and behind #include are left out.
# Line numbers are kept, so that a warning of Doxygen leads to the right line.
# usage: awk -f docs/doxygen_filter.awk HEADER

{ line[NR] = $0 }

END {
  find_comments()
  drop_passing_macros()
  at = 1
  head_block()
  while (at <= NR) statement()
  for (i = 1; i <= NR; i++) print out[i]
}

# ---- comments -----------------------------------------------------------------------------------

# code[i]: line i without its comments. own[i]: number of the comment that begins line i.
# tail[i]: number of the comment that begins behind the code of line i and ends its own last line.
function find_comments(i, rest, p, q, open, k)
{
  for (i = 1; i <= NR; i++) {
    rest = line[i]
    code[i] = ""
    for (;;) {
      if (open) {
        p = index(rest, "*/")
        if (!p) { add_line(k, rest); rest = ""; break }
        add_line(k, substr(rest, 1, p - 1))
        rest = substr(rest, p + 2)
        last[k] = i
        open = 0
        if (rest ~ /[^ \t]/) inside[k] = 1
        continue
      }
      p = index(rest, "/*")
      q = index(rest, "//")
      if (q && (!p || q < p) && rest !~ /"[^"]*\/\//) { rest = substr(rest, 1, q - 1); continue }
      if (!p) { code[i] = code[i] rest; break }
      code[i] = code[i] substr(rest, 1, p - 1)
      k = ++comments
      first[k] = i
      text_lines[k] = 0
      if (code[i] ~ /[^ \t]/) tail[i] = k
      else own[i] = k
      rest = substr(rest, p + 2)
      open = 1
    }
    sub(/[ \t]+$/, "", code[i])
    out[i] = code[i]
  }
}

function add_line(k, s)
{
  sub(/[ \t]+$/, "", s)
  if (text_lines[k] > 0) sub(/^ \*( |$)/, "   ", s)
  text[k, ++text_lines[k]] = s
}

# What means something to Doxygen means only itself here.
function plain(s)
{
  gsub(/[\\@&<>#%$]/, "\\\\&", s)
  while (match(s, /`[^`]+`/))
    s = substr(s, 1, RSTART - 1) "<tt>" substr(s, RSTART + 1, RLENGTH - 2) "</tt>" \
        substr(s, RSTART + RLENGTH)
  return s
}

# A comment in one line.
function flat(k, i, s, t)
{
  s = ""
  for (i = 1; i <= text_lines[k]; i++) {
    t = text[k, i]
    sub(/^[ \t]+/, "", t)
    s = s (s == "" || t == "" ? "" : " ") t
  }
  return plain(s)
}

# A comment that stands by itself, in place; more: what is said behind the declaration; what: of
# what it is said, if not of the next declaration. Lines that are set in further than the text are
# formulas and tables: they keep their shape.
function put_above(k, more, what, i, s, b, deep, was)
{
  was = 0
  b = base(k)
  for (i = 1; i <= text_lines[k]; i++) {
    s = text[k, i]
    match(s, /^ */)
    deep = i > 1 && s != "" && RLENGTH >= b + 2
    if (!deep) s = plain(s)
    if (deep && !was) s = "\\verbatim" s # on one line: no line may be added
    if (!deep && was) s = "\\endverbatim" s
    was = deep
    out[first[k] + i - 1] = (i == 1 ? "/** " what : "") s
  }
  out[last[k]] = out[last[k]] (was ? " \\endverbatim" : "") (more == "" ? "" : " " more) " */"
}

# The indentation of the text of a comment below its first line.
function base(k, i, b)
{
  b = 1000
  for (i = 2; i <= text_lines[k]; i++)
    if (text[k, i] ~ /[^ ]/) {
      match(text[k, i], /^ */)
      if (RLENGTH < b) b = RLENGTH
    }
  return b
}

function file_name(s)
{
  s = FILENAME
  sub(/.*\//, "", s)
  return s
}

# A macro that its own file undefines again is no part of what the file offers.
function drop_passing_macros(i, j, name)
{
  for (i = 1; i <= NR; i++) {
    if (code[i] !~ /^[ \t]*#[ \t]*undef/) continue
    name = code[i]
    sub(/^[ \t]*#[ \t]*undef[ \t]+/, "", name)
    for (j = 1; j < i; j++)
      if (code[j] ~ "^[ \t]*#[ \t]*define[ \t]+" name "([( \t]|$)") code[j] = out[j] = ""
    code[i] = out[i] = ""
  }
}

# ---- the head of the file -----------------------------------------------------------------------

# What stands behind "--" is the brief description; the block is shown as it stands.
function head_block(k, i, s, brief)
{
  k = own[1]
  if (!k) return
  brief = s = text[k, 1]
  sub(/.*-- /, "", brief)
  out[1] = "/** \\file " file_name() " \\brief " plain(brief)
  if (text_lines[k] > 1) {
    out[1] = out[1] " \\verbatim " s
    for (i = 2; i <= text_lines[k]; i++) out[i] = text[k, i]
    out[last[k]] = out[last[k]] " \\endverbatim"
  }
  out[last[k]] = out[last[k]] " */"
  at = last[k] + 1
}

# ---- statements at file level -------------------------------------------------------------------

function statement(i, s, k)
{
  s = code[at]
  if (s !~ /[^ \t]/) {
    k = own[at]
    if (k && !inside[k]) {
      at = last[k] + 1
      if (code[at] !~ /[^ \t]/ || code[at] ~ /^[ \t]*#[ \t]*(if|else|elif|endif|include|pragma)/)
        put_above(k, "", "\\file " file_name() " ") # between blank lines: said of the whole file
    } else at++
    return
  }
  if (s ~ /^[ \t]*#[ \t]*ifdef[ \t]+__cplusplus/) {
    while (at <= NR && code[at] !~ /^[ \t]*#[ \t]*endif/) out[at++] = ""
    out[at++] = ""
    return
  }
  if (s ~ /^[ \t]*#/) { directive(); return }
  if (s ~ /^[A-Z][A-Z0-9_]*$/) { out[at++] = ""; return } # a macro that opens or closes extern "C"
  declaration()
}

# The comment that ends on the line above line i, or 0.
function above(i, k)
{
  for (k = comments; k > 0; k--)
    if (last[k] == i - 1 && own[first[k]] == k && !inside[k]) return k
  return 0
}

function directive(from, to, name)
{
  from = to = at
  while (code[to] ~ /\\$/ && to < NR) to++
  at = to + 1
  if (code[from] !~ /^[ \t]*#[ \t]*define/) return
  name = code[from]
  sub(/^[ \t]*#[ \t]*define[ \t]+/, "", name)
  sub(/[^A-Za-z0-9_].*/, "", name)
  document(from, to, name)
}

function declaration(from, i, depth, aggregate, body, s, n, c, all, head, j)
{
  from = at
  depth = aggregate = body = 0
  all = head = ""
  for (i = from; i <= NR; i++) {
    s = code[i]
    all = all " " s
    n = length(s)
    if (depth > 0 && aggregate) member_comments(i)
    for (j = 1; j <= n; j++) {
      c = substr(s, j, 1)
      if (c == "{") {
        if (depth == 0) {
          aggregate = all ~ /^ *(typedef +)?(struct|enum|union)[ {A-Za-z0-9_]*\{?/ && \
                      all !~ /\)[^{]*\{/
          body = !aggregate
          if (body) head = all
        }
        depth++
      } else if (c == "}") depth--
    }
    if (depth == 0 && (s ~ /;$/ || (body && s ~ /\}$/))) break
  }
  if (i > NR) i = NR
  at = last_line(i) + 1
  document(from, i, name_of(head == "" ? all : head))
}

# A comment behind the end of a declaration may go on below it.
function last_line(i) { return tail[i] && last[tail[i]] > i ? last[tail[i]] : i }

function name_of(all, s)
{
  s = all
  sub(/^[ \t]+/, "", s)
  if (s ~ /\}/) { # a struct or an enum: the word behind its body, else the one before it
    sub(/.*\}/, "", s)
    if (s ~ /[A-Za-z0-9_]/) return last_word(s)
    s = all
    sub(/[ \t]*\{.*/, "", s)
    sub(/^[ \t]*(typedef +)?(struct|union|enum) */, "", s)
    return s
  }
  if (s ~ /^typedef/) { # the last word, or the (*name) of a type of functions
    if (match(s, /\(\*[A-Za-z0-9_]+\)/)) return substr(s, RSTART + 2, RLENGTH - 3)
    return last_word(s)
  }
  if (match(s, /[A-Za-z0-9_]+\(/)) return substr(s, RSTART, RLENGTH - 1)
  return ""
}

function last_word(s)
{
  sub(/[ \t]*(\[[^\]]*\])*[ \t]*;[ \t]*$/, "", s)
  sub(/.*[^A-Za-z0-9_]/, "", s)
  return s
}

# The documentation of the declaration or macro on lines from..to. What has no comment above it and
# follows another without a blank line shares that one's.
function document(from, to, name, k, said)
{
  k = above(from)
  said = ""
  if (tail[to] && !inside[tail[to]]) {
    said = flat(tail[to])
    clear(tail[to])
  }
  if (k) {
    put_above(k, said)
    group = k
    group_name = name
  } else if (group && group_end == from - 1) {
    if (said != "") said = said (group_name == "" ? "" : " \\sa " group_name)
    else said = group_name == "" ? flat(group) : "\\copydoc " group_name
  } else {
    group = 0
    if (said == "") said = known(from, name)
  }
  if (said != "" && !k) out[from] = "/** " said " */ " out[from]
  group_end = last_line(to)
}

# What needs no words of its own.
function known(from, name)
{
  if (name == "") return ""
  if (code[from] ~ "^ *typedef +(struct|union) +" name " +" name ";")
    return "An object that is known by its pointer only; the head of this file describes it."
  if (code[from] !~ /^[ \t]*#/) return ""
  if (name ~ /_$/) return "A part of other macros of this file, not for use by itself."
  for (i = from; i <= NR; i++)
    if (code[i] ~ "^[ \t]*#[ \t]*undef[ \t]+" name "$")
      return "A part of other macros of this file, which undefines it."
  return ""
}

# The lines that a comment behind something takes up are without it.
function clear(k, i)
{
  for (i = first[k]; i <= last[k]; i++) out[i] = code[i]
}

# ---- members ------------------------------------------------------------------------------------

function member_comments(i, k, s)
{
  k = own[i]
  if (k && !inside[k] && code[last[k] + 1] ~ /[A-Za-z0-9_]/ && code[last[k] + 1] !~ /^[ \t]*[}#]/) {
    put_above(k, "")
    return
  }
  k = tail[i]
  if (!k || inside[k] || code[i] ~ /\{$/) return
  s = "/**< " flat(k) " */"
  clear(k)
  out[i] = each_member(code[i], s)
}

# `double rho, nu;` and `A, B,`: the comment of the line belongs to each of them.
function each_member(c, s, n, parts, j, type, result)
{
  if (c ~ /[(){}=]/) return c " " s
  if (c ~ /;$/) {
    sub(/;$/, "", c)
    n = split(c, parts, /,/)
    if (n == 1) return c "; " s
    if (parts[1] ~ /:/) return c "; " s
    type = parts[1]
    sub(/[*A-Za-z0-9_]+[ \t]*(\[[^\]]*\])*[ \t]*$/, "", type)
    result = parts[1] "; " s
    for (j = 2; j <= n; j++) result = result " " type parts[j] "; " s
    return result
  }
  n = split(c, parts, /,/)
  result = ""
  for (j = 1; j <= n; j++)
    if (parts[j] ~ /[A-Za-z0-9_]/) result = result parts[j] (j < n ? "," : "") " " s
  return result
}
