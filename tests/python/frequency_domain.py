"""Output error and equation error in the frequency domain of data/elevator.csv by numpy and scipy alone, for the reference numbers of
tests/numbers/frequency.rs. Run from the top of the repository."""

# independent reference: frequency-domain output error of data/elevator.csv, short-period, numpy/scipy only
import numpy as np, csv, sys
from scipy.optimize import minimize, least_squares
rows=list(csv.reader(l for l in open('data/elevator.csv') if not l.startswith('#')))
head=rows[0]; print(head)
d=np.array([[float(x) for x in r] for r in rows[1:]])
col={h.split('[')[0].split('(')[0].strip():i for i,h in enumerate(head)}
deg=np.pi/180
t=d[:,col['time']] if 'time' in col else d[:,0]
de=d[:,col['de']]*deg; al=d[:,col['alpha']]*deg; q=d[:,col['q']]*deg
N=len(t); h=0.04; T=(N-1)*h
lo,hi=0.1,1.5
k=np.arange(np.ceil(lo*T-1e-6),np.floor(hi*T+1e-6)+1)
om=2*np.pi*k/T
gx,gw=np.polynomial.legendre.leggauss(12); gx=(gx+1)/2; gw=gw/2
def lag(nodes,x):
    return np.array([np.prod([(x-nodes[m])/(nodes[j]-nodes[m]) for m in range(4) if m!=j],axis=0) for j in range(4)])
def ft(x,kind):
    out=np.zeros(len(om),complex)
    for j in range(N-1):
        if kind=='cubic':
            s=min(max(j-1,0),N-4); L=lag(np.arange(4.0),gx+(j-s)); v=L.T@x[s:s+4]
        else: v=x[j]*(1-gx)+x[j+1]*gx
        tt=(j+gx)*h
        out+= (np.exp(-1j*np.outer(om,tt))*(v*gw*h)).sum(1)
    return out
sc=1/(h*np.sqrt(N/2))
U=ft(de-de[0],'line')*sc
Z=np.array([ft(al-al.mean(),'cubic'),ft(q-q.mean(),'cubic')])*sc
E=np.exp(-1j*om*T)
tau=((1-E)/(1j*om)-T*E)/(1j*om)*sc
jw=1j*om
def model(p):
    Za,Zq,Zde,Ma,Mq,Mde=p[:6]; d1,d2,r1,r2=p[6:]
    f1=Zde*U+d1*sc; f2=Mde*U+d2*sc
    det=(jw-Za)*(jw-Mq)-Zq*Ma
    x1=((jw-Mq)*f1+Zq*f2)/det; x2=(Ma*f1+(jw-Za)*f2)/det
    return np.array([x1+r1*tau,x2+r2*tau])
def resid(p,s):
    e=(Z-model(p))/s[:,None]; return np.concatenate([e.real.ravel(),e.imag.ravel()])
p=np.array([-0.8,0.97,-0.1,-3,-1.5,-4.5,0,0,0,0.0]); s=np.ones(2)*1e-3
free=[0,1,2,3,4,5]
for it in range(60):
    r=least_squares(lambda v: resid(v,s),p,xtol=1e-15,ftol=1e-15,gtol=1e-15,x_scale='jac')
    p=r.x; e=Z-model(p); s=np.sqrt((abs(e)**2).sum(1)/(2*len(om)))
M=len(om); print('M',M,'s',s)
C=np.linalg.inv(r.jac.T@r.jac); se=np.sqrt(np.diag(C))
cost=sum(2*M*np.log(si) for si in s)+0.5*4*M+0.5*4*M*np.log(2*np.pi)
for n,v,x in zip('Za Zq Zde Ma Mq Mde'.split(),p,se): print(n,repr(float(v)),repr(float(x)))
print('cost',repr(float(cost)))
# equation error
A=np.array([al,q])
XS=np.array([ft(al-al[0],'cubic'),ft(q-q[0],'cubic')])*sc
for i,nm in enumerate(['alpha','q']):
    y=jw*XS[i]+ (A[i,-1]-A[i,0])*E*sc
    R=np.array([XS[0],XS[1],U,np.full(M,sc),tau]).T
    RR=np.vstack([R.real,R.imag]); yy=np.concatenate([y.real,y.imag])
    sol=np.linalg.lstsq(RR,yy,rcond=None)[0]; res=yy-RR@sol; s2=res@res/len(yy)
    sd=np.sqrt(np.diag(np.linalg.inv(RR.T@RR))*s2)
    print('eq',nm,[float(v) for v in sol[:3]],[float(v) for v in sd[:3]])
