"""Style of a page: text, tables, light and dark; --l1 to --l4 are levels, the worst last."""

BASE = """
:root{color-scheme:light dark;--text:#222;--paper:#fff;--soft:#666;--line:#bbb;--link:#0b57a4;--red:#b00000;
--l1:#fdebd3;--l2:#f9c188;--l3:#e9832f;--l4:#8c2d04;--t3:#111;--t4:#fff}
@media (prefers-color-scheme:dark){:root{--text:#ddd;--paper:#181818;--soft:#aaa;--line:#555;--link:#8fc4ff;--red:#ff6b6b;
--l1:#3a2714;--l2:#69400f;--l3:#ad5d12;--l4:#ffb366;--t3:#fff;--t4:#111}}
body{font:16px/1.45 system-ui,sans-serif;color:var(--text);background:var(--paper);max-width:62rem;margin:0 auto;padding:1rem}
a{color:var(--link)}h2{margin:2rem 0 .4rem}h3{margin:2rem 0 .4rem}.soft{color:var(--soft);font-size:.9rem}
.scroll{overflow-x:auto}table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{border:1px solid var(--line);padding:.2rem .5rem;text-align:center;white-space:nowrap}
th[scope=row]{text-align:right;font-weight:400;position:sticky;left:0;background:var(--paper)}
th.default{font-weight:700}td a{color:inherit;text-decoration:none;display:block}td a:hover,td a:focus{text-decoration:underline}
"""
